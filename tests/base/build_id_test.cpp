#include "base/build_id.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace ukemi {
namespace {

namespace fs = std::filesystem;

/// A source tree of its own, hashed by the script that the build runs.
class BuildId : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "ukemi_build_id_XXXXXX").string();
    root_ = mkdtemp(name.data());
    write("base/a.h", "int a();");
    write("load/b.cpp", "int a() { return 1; }");
    first_ = id();
  }
  void TearDown() override { fs::remove_all(root_); }

  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / "src" / file).parent_path());
    std::ofstream(root_ / "src" / file) << text;
  }
  /// What the script writes: a source file with the id in it.
  std::string id(const std::string& tools = "GNU 12 -O3") const {
    const std::string command = std::string(UKEMI_CMAKE) + " -D SOURCES=" + (root_ / "src").string() +
                                " -D OUT=" + (root_ / "id.cpp").string() + " -D 'TOOLS=" + tools + "' -P " +
                                UKEMI_BUILD_ID_SCRIPT;
    EXPECT_EQ(std::system(command.c_str()), 0);
    std::ostringstream text;
    text << std::ifstream(root_ / "id.cpp").rdbuf();
    EXPECT_NE(text.str().find("ukemi::build_id() { return \""), std::string::npos) << text.str();
    return text.str();
  }

  fs::path root_;
  std::string first_;
};

TEST_F(BuildId, IsThatOfTheSourcesAndNotOfTheirTimes) {
  write("base/a.h", "int a();");
  fs::last_write_time(root_ / "src/load/b.cpp", fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_EQ(id(), first_);
}

TEST_F(BuildId, ChangesWithATextANameAndTheCompiler) {
  EXPECT_NE(id("GNU 12 -O0"), first_);
  fs::rename(root_ / "src/load/b.cpp", root_ / "src/load/c.cpp");
  EXPECT_NE(id(), first_);
  fs::rename(root_ / "src/load/c.cpp", root_ / "src/load/b.cpp");
  EXPECT_EQ(id(), first_);
  write("load/b.cpp", "int a() { return 2; }");
  EXPECT_NE(id(), first_);
}

TEST_F(BuildId, IsNotThatOfNotes) {
  write("base/README.md", "notes");
  EXPECT_EQ(id(), first_);
}

TEST(ProgramsBuildId, IsASha256) {
  EXPECT_EQ(build_id().size(), 64u);
  EXPECT_EQ(build_id().find_first_not_of("0123456789abcdef"), std::string_view::npos);
}

}  // namespace
}  // namespace ukemi
