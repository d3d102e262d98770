#include "layering/layering.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace ukemi {
namespace {

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

/// A source tree in a folder of its own, removed at the end.
class Tree {
 public:
  Tree() {
    std::string name = (fs::temp_directory_path() / "ukemi_layering_XXXXXX").string();
    root_ = mkdtemp(name.data());
  }
  ~Tree() { fs::remove_all(root_); }
  void add(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  Strings foreign_random_numbers() const { return ukemi::foreign_random_numbers(root_); }
  LayeringReport check() const { return check_layering(root_); }
  Strings violations() const { return check().violations; }

 private:
  fs::path root_;
};

TEST(Layering, HoldsInTheWholeSourceTree) {
  const LayeringReport report = check_layering(UKEMI_PROJECT_FOLDER "/src");
  EXPECT_EQ(report.violations, Strings{});
  EXPECT_GT(report.files, 20);
  EXPECT_GT(report.includes, 100);
  EXPECT_GT(report.types, 200);
}

TEST(Layering, ReportsALaterRoomByFileAndLine) {
  const Tree tree;
  tree.add("base/math.h", "#pragma once\n\n#include <Eigen/Core>\n");
  tree.add("simulate/simulate.h", "#include \"base/math.h\"\n");
  tree.add("body/body.cpp", "// body\n#include <vector>\n#include \"simulate/simulate.h\"\n");
  EXPECT_EQ(tree.violations(), (Strings{"body/body.cpp:3: body must not include simulate/simulate.h"}));
}

TEST(Layering, KeepsExportAndRenderApart) {
  const Tree tree;
  tree.add("export/export.h", "");
  tree.add("export/write.cpp", "#include \"render/render.h\"\n");
  tree.add("render/render.h", "#include \"export/export.h\"\n");
  EXPECT_EQ(tree.violations(), (Strings{"export/write.cpp:1: export must not include render/render.h",
                                        "render/render.h:1: render must not include export/export.h"}));
}

TEST(Layering, KeepsTheRoomsBehindABakeApart) {
  const Tree tree;
  tree.add("bake/bake.h", "");
  tree.add("batch/batch.h", "#include \"bake/bake.h\"\n#include \"study/compare.h\"\n");
  tree.add("check/rom.h", "");
  tree.add("review/page.h", "#include \"batch/batch.h\"\n#include \"review/mesh.h\"\n");
  tree.add("review/mesh.h", "");
  tree.add("study/compare.h", "#include \"check/rom.h\"\n");
  EXPECT_EQ(tree.violations(), (Strings{"batch/batch.h:2: batch must not include study/compare.h",
                                        "review/page.h:1: review must not include batch/batch.h",
                                        "study/compare.h:1: study must not include check/rom.h"}));
}

TEST(Layering, ReportsAThirdPartyOutsideItsRoomOrInAHeader) {
  const Tree tree;
  tree.add("body/body.cpp",
           "  #  include <ode/ode.h>\n#include \"assimp/scene.h\"\n#include <fmt/format.h>\n");
  tree.add("bake/options.cpp", "#include <CLI/CLI.hpp>\n");
  tree.add("cli/main.cpp", "#include <CLI/CLI.hpp>\n#include <nlohmann/json.hpp>\n");
  tree.add("physics/world.h", "#include <ode/ode.h>\n");
  tree.add("physics/world.cpp", "#include <ode/ode.h>\n");
  EXPECT_EQ(tree.violations(), (Strings{"bake/options.cpp:1: bake must not include CLI/CLI.hpp",
                                        "body/body.cpp:1: body must not include ode/ode.h",
                                        "body/body.cpp:2: body must not include assimp/scene.h",
                                        "cli/main.cpp:2: cli must not include nlohmann/json.hpp",
                                        "physics/world.h:1: a header must not include ode/ode.h"}));
}

TEST(Layering, ReportsUnknownHeadersFoldersAndFiles) {
  const Tree tree;
  tree.add("base/math.h", "#include \"result.h\"\n#include \"base/gone.h\"\n#include <boost/any.hpp>\n");
  tree.add("base/files.cpp", "#include <sys/stat.h>\n#include <unistd.h>\n#include <cmath>\n");
  tree.add("helpers/text.h", "");
  tree.add("load/read.hpp", "");
  EXPECT_EQ(
      tree.violations(),
      (Strings{"base/math.h:1: name result.h by its room's folder",
               "base/math.h:2: base/gone.h does not exist", "base/math.h:3: unknown header boost/any.hpp",
               "helpers/text.h: helpers is not a known room", "load/read.hpp: is neither .h nor .cpp"}));
}

TEST(Layering, ReportsATypeThatIsDefinedTwice) {
  const Tree tree;
  tree.add("base/a.h", "namespace ukemi {\nstruct Figure {\n};\nenum class Kind : int { one };\n}\n");
  tree.add("base/b.cpp",
           "namespace ukemi {\nnamespace {\nclass Figure final {\n};\nstruct Local {};\n"
           "}  // namespace\nusing Kind = int;\n}\n");
  tree.add("load/c.h", "struct Figure : Base {\n};\nstruct Kind;\n");
  EXPECT_EQ(tree.violations(), (Strings{"base/b.cpp:3: Figure is defined in base/a.h:2 too",
                                        "load/c.h:1: Figure is defined in base/a.h:2 too",
                                        "base/b.cpp:7: Kind is defined in base/a.h:4 too"}));
}

TEST(Layering, LetsFilesHaveTypesOfTheirOwnWithTheSameName) {
  const Tree tree;
  for (const char* file : {"base/a.cpp", "base/b.cpp"})
    tree.add(file, "namespace ukemi {\nnamespace {\nstruct Key {};\n}  // namespace\n}\nstruct Other;\n");
  EXPECT_EQ(tree.violations(), Strings{});
  EXPECT_EQ(tree.check().types, 2);
}

TEST(Layering, ReportsAnIncludeCycleBetweenModulesOfARoom) {
  const Tree tree;
  tree.add("body/body.h", "");
  tree.add("body/body.cpp", "#include \"body/body.h\"\n#include \"body/shapes.h\"\n");
  tree.add("body/shapes.h", "#include \"body/table.h\"\n");
  tree.add("body/table.h", "#include \"body/body.h\"\n");
  tree.add("body/mass.cpp", "#include \"body/body.h\"\n");
  EXPECT_EQ(tree.violations(), (Strings{"body/body: includes itself by way of body/shapes body/table"}));
}

TEST(Layering, ReportsARoomThatIsTooLongButNotTheRenderer) {
  const Tree tree;
  const std::string lines(2000, '\n');
  for (const char* file : {"load/a.h", "load/b.cpp", "render/a.h", "render/b.cpp", "bake/a.cpp"})
    tree.add(file, lines);
  EXPECT_EQ(tree.violations(), (Strings{"load: 4000 lines are more than 3600"}));
}

TEST(Layering, EveryRandomNumberIsOfTheProjectsOwnGenerator) {
  EXPECT_EQ(foreign_random_numbers(UKEMI_PROJECT_FOLDER "/src"), Strings{});
  EXPECT_EQ(foreign_random_numbers(UKEMI_PROJECT_FOLDER "/tools"), Strings{});
  Strings tests = foreign_random_numbers(UKEMI_PROJECT_FOLDER "/tests");
  std::erase_if(tests,
                [](const std::string& place) { return place.starts_with("layering/layering_test.cpp"); });
  EXPECT_EQ(tests, Strings{});
}

TEST(Layering, ReportsRandomNumbersThatDifferBetweenLibraries) {
  const Tree tree;
  tree.add("load/a_test.cpp",
           "#include <random>\nstd::mt19937 g(1);\nreturn std::normal_distribution<double>(0, 1)(g);\n");
  tree.add("body/b.h", "const Vec3 axis = Vec3::Random();\nint operand(int);\n");
  tree.add("body/c.cpp", "srand(1);\nconst int i = rand() % 3;\n");
  tree.add("node_modules/c.cpp", "srand(1);\n");
  EXPECT_EQ(tree.foreign_random_numbers(),
            (Strings{"body/b.h:1: ::Random(: take base/random.h", "body/c.cpp:1: srand(: take base/random.h",
                     "body/c.cpp:2: rand(: take base/random.h",
                     "load/a_test.cpp:1: #include <random>: take base/random.h",
                     "load/a_test.cpp:2: std::mt19937: take base/random.h",
                     "load/a_test.cpp:3: std::normal_distribution: take base/random.h"}));
}

TEST(Layering, CountsTheFilesAndIncludesItLookedAt) {
  const Tree tree;
  tree.add("base/README.md", "#include <vector>");
  EXPECT_EQ(tree.check().files, 0);
  tree.add("base/math.h", "#include <vector>\n#include <string>\n");
  EXPECT_EQ(tree.check().files, 1);
  EXPECT_EQ(tree.check().includes, 2);
}

}  // namespace
}  // namespace ukemi
