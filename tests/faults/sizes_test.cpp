// Large and swollen inputs: done in bounded time and memory, or refused at once.
#include <cmath>
#include <fstream>

#include "cli/glb_file.h"
#include "cli/program.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;
using test::GlbFile;

const fs::path kCharacters = fs::path(UKEMI_ASSETS_FOLDER) / "characters";

class Sizes : public Program {
 protected:
  /// Runs and expects success within so much processor time and memory.
  Ran within(double seconds, double megabytes, const std::vector<std::string>& arguments) {
    Ran ran = run(arguments);
    SCOPED_TRACE(arguments[0] + " " + arguments[1]);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_LT(ran.processor_s, seconds);
    EXPECT_LT(ran.memory_mb, megabytes);
    RecordProperty(arguments[0] + "_s", std::to_string(ran.processor_s));
    RecordProperty(arguments[0] + "_mb", std::to_string(ran.memory_mb));
    return ran;
  }
  /// Runs and expects a refusal that says so within a few seconds.
  void refused_at_once(const std::vector<std::string>& arguments, const std::string& what) {
    const Ran ran = run(arguments);
    EXPECT_EQ(ran.status, 2);
    EXPECT_NE(ran.err.find(what), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("\n  fix: "), std::string::npos);
    EXPECT_LT(ran.processor_s, 10.0);
    EXPECT_LT(ran.memory_mb, 1500.0);
  }

  /// The mannequin's BVH with `count` further joints in rows of `row`, two frames.
  void write_bvh(const std::string& name, int count, int row) const {
    std::string text = content(kCharacters / "mannequin.bvh");
    const std::size_t motion = text.find("MOTION");
    const std::size_t root_end = text.rfind('}', motion);
    std::ofstream file(folder / name);
    file << text.substr(0, root_end);
    for (int i = 0; i < count; ++i) {
      file << "JOINT extra" << i << "\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n";
      if ((i + 1) % row != 0 && i + 1 < count) continue;
      file << "End Site\n{\nOFFSET 0 1 0\n}\n";
      for (int open = i % row; open >= 0; --open) file << "}\n";
    }
    file << "}\nMOTION\nFrames: 2\nFrame Time: 0.0333333\n";
    const std::string frame = first_row(text);
    std::string rest;
    for (int i = 0; i < 3 * count; ++i) rest += " 0";
    for (int f = 0; f < 2; ++f) file << frame << rest << '\n';
  }

  static std::string first_row(const std::string& bvh) {
    const std::size_t begin = bvh.find('\n', bvh.find("Frame Time")) + 1;
    return bvh.substr(begin, bvh.find_first_of("\r\n", begin) - begin);
  }

  static std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  static GlbFile mannequin() { return GlbFile(kCharacters / "mannequin.glb"); }

  /// Nodes below the first root. Returns the index of the first.
  static int add_nodes(GlbFile& glb, int count) {
    const int first = static_cast<int>(glb.json["nodes"].size());
    const std::size_t root = glb.json["scenes"][0]["nodes"][0];
    for (int i = 0; i < count; ++i) {
      glb.json["nodes"][root]["children"].push_back(first + i);
      glb.json["nodes"].push_back({{"name", "extra" + std::to_string(i)}, {"translation", {0, 0.01, 0}}});
    }
    return first;
  }
};

TEST_F(Sizes, ABvhOfTenThousandJoints) {
  for (const int row : {1, 500}) {
    write_bvh("many.bvh", 10000, row);
    within(5.0, 300.0, {"inspect", "many.bvh"});
    within(10.0, 600.0, {"bake", "many.bvh", "--duration", "0.2", "-o", "out.glb"});
    within(10.0, 600.0, {"bake", "many.bvh", "--duration", "0.2", "-o", "out.bvh"});
  }
}

TEST_F(Sizes, ASkinOfFiveThousandBones) {
  GlbFile glb = mannequin();
  const int first = add_nodes(glb, 5000);
  Json& skin = glb.json["skins"][0];
  const Json old = glb.json["accessors"][skin["inverseBindMatrices"].get<std::size_t>()];
  const std::size_t view = old["bufferView"], count = old["count"];
  std::vector<float> matrices(16 * (count + 5000), 0.0f);
  const std::size_t offset = glb.json["bufferViews"][view].value("byteOffset", std::size_t{0}) +
                             old.value("byteOffset", std::size_t{0});
  std::memcpy(matrices.data(), glb.binary.data() + offset, 64 * count);
  for (std::size_t m = count; m < count + 5000; ++m)
    for (std::size_t k = 0; k < 4; ++k) matrices[16 * m + 5 * k] = 1.0f;
  for (int i = 0; i < 5000; ++i) skin["joints"].push_back(first + i);
  skin["inverseBindMatrices"] = glb.add(matrices, "MAT4", 16);
  glb.write(folder / "skin.glb");
  within(10.0, 600.0, {"bake", "skin.glb", "-o", "out.glb"});
  within(10.0, 600.0, {"render", "skin.glb", "--cells", "1", "-o", "out.png"});
}

TEST_F(Sizes, AHundredThousandNodes) {
  GlbFile glb = mannequin();
  add_nodes(glb, 100000);
  glb.write(folder / "nodes.glb");
  within(10.0, 1500.0, {"inspect", "nodes.glb"});
  within(20.0, 2000.0, {"bake", "nodes.glb", "--duration", "0.2", "-o", "out.glb"});
  refused_at_once({"bake", "nodes.glb", "--fps", "240", "--no-until-rest", "-o", "out.glb"},
                  "more than 16777216 transforms");
}

TEST_F(Sizes, ABvhOfAnHour) {
  const std::string text = content(kCharacters / "mannequin.bvh");
  const std::string row = first_row(text);
  {
    std::ofstream file(folder / "hour.bvh");
    file << text.substr(0, text.find("MOTION")) << "MOTION\nFrames: 108000\nFrame Time: 0.0333333\n";
    const std::size_t third = row.find(' ', row.find(' ') + 1);
    for (int i = 0; i < 108000; ++i)
      file << i % 100 << ' ' << row.substr(third + 1, row.npos).insert(0, "90 ") << '\n';
  }
  within(60.0, 1500.0, {"inspect", "hour.bvh"});
  within(20.0, 800.0, {"bake", "hour.bvh", "--at", "1800", "--duration", "0.2", "-o", "out.glb"});
}

TEST_F(Sizes, AGlbOfAMillionKeys) {
  GlbFile glb = mannequin();
  const std::size_t keys = 1000000;
  std::vector<float> times(keys), values(4 * keys);
  for (std::size_t i = 0; i < keys; ++i) {
    times[i] = 0.0036f * static_cast<float>(i);
    const double half = 0.05 * std::sin(0.01 * static_cast<double>(i));
    values[4 * i] = static_cast<float>(std::sin(half));
    values[4 * i + 3] = static_cast<float>(std::cos(half));
  }
  const int input = glb.add(times, "SCALAR", 1), output = glb.add(values, "VEC4", 4);
  int head = 0;
  while (glb.json["nodes"][static_cast<std::size_t>(head)]["name"] != "Head") ++head;
  glb.json["animations"] =
      Json::array({{{"name", "long"},
                    {"samplers", {{{"input", input}, {"output", output}}}},
                    {"channels", {{{"sampler", 0}, {"target", {{"node", head}, {"path", "rotation"}}}}}}}});
  glb.write(folder / "keys.glb");
  within(60.0, 1500.0, {"inspect", "keys.glb"});
  within(10.0, 500.0,
         {"bake", "keys.glb", "--clip", "long", "--at", "1800", "--duration", "0.2", "-o", "out.glb"});
}

TEST_F(Sizes, TooManyNodesJointsNumbersOrValuesAreRefused) {
  GlbFile glb = mannequin();
  add_nodes(glb, 1 << 18);
  glb.write(folder / "nodes.glb");
  refused_at_once({"inspect", "nodes.glb"}, "nodes; the limit is 262144");
  write_bvh("joints.bvh", 1 << 18, 1);
  refused_at_once({"inspect", "joints.bvh"}, "has more than 262144 joints");
  std::string bvh = content(kCharacters / "mannequin.bvh");
  bvh = bvh.substr(0, bvh.find("MOTION")) + "MOTION\nFrames: 8000000\nFrame Time: 0.01\n";
  write("long.bvh", bvh);
  refused_at_once({"inspect", "long.bvh"}, "together more than 100000000");
  std::string json = R"({"asset": {"version": "2.0"}, "nodes": [{}], "extras": [)";
  for (int i = 0; i < 10'000'000; ++i) json += "0,";
  write("values.gltf", json + "0]}");
  refused_at_once({"inspect", "values.gltf"}, "more than 10000000 values");
}

TEST_F(Sizes, PartsThatShareTheirDataDoNotSwell) {
  GlbFile glb = mannequin();
  glb.json["accessors"].push_back({{"componentType", 5126}, {"type", "VEC3"}, {"count", 3}});
  const std::size_t positions = glb.json["accessors"].size() - 1;
  glb.json["accessors"].push_back({{"componentType", 5125}, {"type", "SCALAR"}, {"count", 30'000'000}});
  const std::size_t indices = positions + 1;
  Json primitives = Json::array();
  for (int i = 0; i < 100; ++i)
    primitives.push_back({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  glb.json["meshes"].push_back({{"primitives", primitives}});
  glb.json["nodes"].push_back({{"mesh", glb.json["meshes"].size() - 1}});
  glb.json["scenes"][0]["nodes"].push_back(glb.json["nodes"].size() - 1);
  glb.write(folder / "swollen.glb");
  EXPECT_LT(fs::file_size(folder / "swollen.glb"), 1'000'000u);
  const Ran ran = run({"inspect", "swollen.glb"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("need more than 4 GiB of memory"), std::string::npos) << ran.err;
  EXPECT_LT(ran.memory_mb, 4500.0);
  EXPECT_LT(ran.processor_s, 30.0);
}

TEST_F(Sizes, AMillionReactionsAreRefusedAHundredThousandPlanned) {
  const auto recipe = [](int variations) {
    return "format = 1\ncharacters = [\"mannequin\"]\noutputs = [\"glb\"]\n[[matrix]]\nhit = [\"head\", "
           "\"chest\"]\nfrom = [0, 90, 180, 270, 45]\nvariations = " +
           std::to_string(variations) + "\njitter = { direction-deg = 10 }\n";
  };
  std::string many = recipe(10000);
  many += "[[matrix]]\nmass = [";
  for (int i = 0; i < 900; ++i) many += std::to_string(50 + i % 40) + ",";
  write("r.toml", many + "]\nvariations = 1000\n");
  refused_at_once({"batch", "r.toml", "-o", "out", "--dry-run"},
                  "describes 1000000 reactions; the limit is 100000");
  write("r.toml", recipe(10000));
  const Ran ran = within(30.0, 1500.0, {"batch", "r.toml", "-o", "out", "--dry-run"});
  EXPECT_NE(ran.out.find("100000 to bake"), std::string::npos);
}

}  // namespace
}  // namespace ukemi
