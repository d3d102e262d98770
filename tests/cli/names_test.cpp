// Names that mean harm, in every place that a name comes from: none of them leaves its place.
#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include "glb_file.h"
#include "program.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

// Ends a script, an attribute and a string, is an escape of terminals, a formula, a line and a JOINT of a
// BVH.
const std::string kHostile =
    "=1+1|cmd</script><img src=x onerror=alert(1)>\"'`\\\x1b[2J\x07\n\xC2\x9B\xE2\x80\xA8{ } JOINT x";

class HostileNames : public Program {
 protected:
  /// The mannequin with a forearm, a clip, a material and a loose node called so.
  void write_character(const std::string& file) const {
    test::GlbFile glb(fs::path(UKEMI_ASSETS_FOLDER) / "characters/mannequin.glb");
    for (Json& node : glb.json["nodes"])
      if (node["name"] == "LeftForeArm") node["name"] = "LeftForeArm" + kHostile;
    glb.json["nodes"].push_back({{"name", kHostile}});
    glb.json["scenes"][0]["nodes"].push_back(glb.json["nodes"].size() - 1);
    for (Json& clip : glb.json["animations"]) clip["name"] = kHostile;
    for (Json& material : glb.json["materials"]) material["name"] = kHostile;
    glb.write(folder / file);
  }

  std::vector<std::string> paths_below(const std::string& name) const {
    std::vector<std::string> paths;
    for (const auto& entry : fs::recursive_directory_iterator(folder / name))
      if (entry.is_regular_file()) paths.push_back(fs::relative(entry.path(), folder / name).string());
    return paths;
  }
};

/// The fields of a table after RFC 4180.
std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    if (csv[i] == '"' && quoted && i + 1 < csv.size() && csv[i + 1] == '"')
      rows.back().back() += csv[i++];
    else if (csv[i] == '"')
      quoted = !quoted;
    else if (csv[i] == ',' && !quoted)
      rows.back().emplace_back();
    else if (csv[i] == '\n' && !quoted)
      rows.push_back({""});
    else
      rows.back().back() += csv[i];
  }
  rows.pop_back();
  return rows;
}

bool is_number(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return end != text.c_str() && (*end == '\0' || *end == '\r' || *end == ',');
}

std::string recipe_text() {
  const auto reaction = [](const std::string& name) {
    return "[[reaction]]\nname = " + Json(name).dump(-1, ' ', true) + "\n";
  };
  std::string text =
      "format = 1\ncharacters = [\"*.glb\"]\noutputs = [\"glb\", \"bvh\", \"report\"]\n[settings]\n"
      "duration = 0.05\nclip-only = true\n";
  for (const std::string& name :
       {std::string("=1+1<script>alert(1)</script>"), std::string("NUL"), std::string("../../outside"),
        std::string("\x1b[2J\n"), std::string(300, 'n')})
    text += reaction(name);
  return text;
}

TEST_F(HostileNames, OfABatchAreHarmlessAsFilesTableManifestAndPage) {
  for (const char* file : {"=cmd|'x'.glb", "CON.glb", "-o.glb", "a\nb\x1b[31m.glb", "bad\xff\xfename.glb",
                           "<img src=x onerror=alert(1)>.glb"})
    write_character(file);
  write_character(std::string(240, 'l') + ".glb");
  write("hits<b>.toml", recipe_text());
  const Ran ran = run({"batch", "hits<b>.toml", "-o", "out", "-j", "2"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ((ran.out + ran.err).find('\x1b'), std::string::npos);

  const Json manifest = Json::parse(read("out/manifest.json"));
  ASSERT_EQ(manifest["reactions"].size(), 35u);
  std::set<std::string> outputs;
  for (const Json& reaction : manifest["reactions"])
    for (const Json& output : reaction["outputs"]) {
      EXPECT_TRUE(fs::exists(folder / "out" / output.get<std::string>())) << output;
      outputs.insert(output);
    }
  EXPECT_EQ(outputs.size(), 70u) << "each its own file";

  for (const std::string& path : paths_below("out")) {
    EXPECT_EQ(path.find_first_of("<>:\"\\|?*'\n\x1b=\xff"), std::string::npos) << path;
    for (const auto& part : fs::path(path)) {
      EXPECT_LE(part.string().size(), 110u);
      EXPECT_NE(part.stem(), "CON");
      EXPECT_NE(part.stem(), "NUL");
      EXPECT_NE(part.string().front(), '-');
    }
  }
  EXPECT_EQ(fs::exists(folder / "outside.glb") || fs::exists(folder / "out/outside.glb"), false);

  const auto rows = rows_of(read("out/manifest.csv"));
  ASSERT_EQ(rows.size(), 36u);
  for (const auto& row : rows) {
    EXPECT_EQ(row.size(), rows[0].size());
    for (const std::string& field : row)
      EXPECT_TRUE(field.empty() || is_number(field) ||
                  std::string("=+-@\t\r").find(field.front()) == std::string::npos)
          << field;
  }

  int scripts = 0;
  for (const std::string& path : paths_below("out")) {
    const bool data = path.starts_with("review/") && path.ends_with(".js") && path != "review/review.js";
    if (data || path == "index.html") {
      EXPECT_EQ(read("out/" + path).find("<img"), std::string::npos) << path;
      EXPECT_EQ(read("out/" + path).find("<b>"), std::string::npos) << path;
    }
    if (!data) continue;
    EXPECT_EQ(read("out/" + path).find('<'), std::string::npos) << path;
    ++scripts;
  }
  EXPECT_GT(scripts, 35);
}

TEST_F(HostileNames, OfClipsInATableAreNoFormulas) {
  write_character("man.glb");
  write("r.toml",
        "format = 1\ncharacters = [\"man.glb\"]\noutputs = [\"bvh\"]\n[[reaction]]\nname = \"a\"\n"
        "duration = 0.05\nat = 0.1\nclip = " +
            Json(kHostile).dump(-1, ' ', true) + "\n");
  const Ran ran = run({"batch", "r.toml", "-o", "out", "--no-review"});
  ASSERT_EQ(ran.status, 0) << ran.out << ran.err;
  const auto rows = rows_of(read("out/manifest.csv"));
  ASSERT_EQ(rows.size(), 2u);
  const auto at = std::find(rows[0].begin(), rows[0].end(), "clip") - rows[0].begin();
  EXPECT_EQ(rows[1].at(static_cast<std::size_t>(at)), "'" + kHostile);
}

TEST_F(HostileNames, ReachTheTerminalWithoutControlCharacters) {
  write_character("man.glb");
  const std::string nasty = "no\x1b[31mne\xC2\x9B.glb";
  const std::vector<std::vector<std::string>> commands = {
      {"inspect", "man.glb"},
      {"render", "man.glb", "-o", "a.png", "--cells", "1"},
      {"bake", "man.glb", "--clip", kHostile, "--at", "99", "-o", "a.glb"},
      {"bake", nasty, "-o", "a.glb"},
      {"inspect", nasty},
      {"diff", "man.glb", "man.glb"},
      {"rom", "--check", "man.glb", "-o", "a.png"},
      {"bake", "man.glb", "--hit", nasty, "-o", "a.glb"}};
  for (const auto& command : commands) {
    const Ran ran = run(command);
    const std::string said = ran.out + ran.err;
    EXPECT_FALSE(said.empty());
    for (const char* control : {"\x1b", "\x07", "\xC2\x9B"})
      EXPECT_EQ(said.find(control), std::string::npos) << command[0] << ": " << said;
  }
}

TEST_F(HostileNames, AreAsTheyAreInJsonAndGltf) {
  write_character("man.glb");
  const Json inspected = Json::parse(run({"inspect", "man.glb", "--json"}).out);
  EXPECT_EQ(inspected["map"]["forearm_l"], "LeftForeArm" + kHostile);
  ASSERT_EQ(run({"bake", "man.glb", "--duration", "0.05", "-o", "a.gltf", "--report", "a.json"}).status, 0);
  EXPECT_EQ(Json::parse(read("a.json"))["humanoid"]["map"]["forearm_l"], "LeftForeArm" + kHostile);
  EXPECT_EQ(Json::parse(read("a.gltf"))["nodes"].back()["name"], kHostile);
}

TEST_F(HostileNames, DoNotBreakTheGrammarOfABvh) {
  write_character("man.glb");
  ASSERT_EQ(run({"bake", "man.glb", "--duration", "0.05", "-o", "a.bvh"}).status, 0);
  const Ran ran = run({"inspect", "a.bvh", "--json"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(Json::parse(ran.out)["verdict"], "humanoid");
  EXPECT_EQ(read("a.bvh").find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace ukemi
