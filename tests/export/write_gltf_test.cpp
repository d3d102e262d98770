#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/animation.h"
#include "base/files.h"
#include "export/export.h"
#include "export/puppet.h"
#include "export/stick_mesh.h"
#include "load/load.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Bytes = std::vector<std::uint8_t>;

std::uint32_t u32(const Bytes& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

/// A GLB taken apart by hand.
struct Glb {
  Json json;
  Bytes bin;
  Bytes further;
};

Glb parse_glb(const Bytes& bytes) {
  EXPECT_EQ(u32(bytes, 0), 0x46546C67u);
  EXPECT_EQ(u32(bytes, 4), 2u);
  EXPECT_EQ(u32(bytes, 8), bytes.size());
  Glb glb;
  std::size_t at = 12;
  for (int chunk = 0; at < bytes.size(); ++chunk) {
    const std::uint32_t size = u32(bytes, at);
    const std::uint32_t type = u32(bytes, at + 4);
    EXPECT_EQ(size % 4, 0u);
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(at) + 8;
    const Bytes content(first, first + size);
    if (chunk == 0) {
      EXPECT_EQ(type, 0x4E4F534Au);
      glb.json = Json::parse(content);
    } else if (type == 0x004E4942u) {
      EXPECT_EQ(chunk, 1);
      glb.bin = content;
    } else {
      glb.further.insert(glb.further.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at), first + size);
    }
    at += 8 + size;
  }
  return glb;
}

std::vector<float> floats_of(const Json& json, const Bytes& bin, std::size_t accessor) {
  const Json& a = json["accessors"][accessor];
  const Json& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
  EXPECT_EQ(a["componentType"], 5126);
  EXPECT_FALSE(view.contains("byteStride"));
  const std::map<std::string, std::size_t> width{{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  std::vector<float> values(a["count"].get<std::size_t>() * width.at(a["type"]));
  const std::size_t at = view["byteOffset"].get<std::size_t>() + a["byteOffset"].get<std::size_t>();
  EXPECT_EQ(at % 4, 0u);
  EXPECT_LE(at + 4 * values.size(),
            view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>());
  EXPECT_LE(at + 4 * values.size(), bin.size());
  std::memcpy(values.data(), bin.data() + at, 4 * values.size());
  return values;
}

/// The animation's tracks read back from the bytes.
std::vector<Track> tracks_of(const Json& json, const Bytes& bin, const Json& animation) {
  std::vector<Track> tracks;
  for (const Json& channel : animation["channels"]) {
    const Json& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
    Track track;
    track.node = channel["target"]["node"];
    const std::string path = channel["target"]["path"];
    track.path = path == "rotation" ? TrackPath::rotation
                 : path == "scale"  ? TrackPath::scale
                                    : TrackPath::translation;
    const auto times = floats_of(json, bin, sampler["input"]);
    const Json& input = json["accessors"][sampler["input"].get<std::size_t>()];
    EXPECT_EQ(input["min"], Json::array({times.front()}));
    EXPECT_EQ(input["max"], Json::array({times.back()}));
    for (std::size_t i = 1; i < times.size(); ++i) EXPECT_LT(times[i - 1], times[i]);
    track.times.assign(times.begin(), times.end());
    const auto values = floats_of(json, bin, sampler["output"]);
    track.values.assign(values.begin(), values.end());
    tracks.push_back(std::move(track));
  }
  return tracks;
}

ReducedClip turn_of(int node, const std::string& name = "hit") {
  const double c = std::sqrt(0.5);
  return {name,
          {{node, TrackPath::rotation, Interpolation::linear, {0, 0.5}, {0, 0, 0, 1, c, 0, 0, c}}},
          2,
          0,
          {}};
}

Character from_json(const std::string& json, std::vector<Bytes> buffers, bool is_glb, int nodes) {
  Character character;
  character.path = "source.glb";
  for (int i = 0; i < nodes; ++i) character.skeleton.nodes.push_back({"n" + std::to_string(i), -1, {}});
  EXPECT_TRUE(character.skeleton.sort());
  character.document = {json, std::move(buffers), {}, is_glb, {}};
  return character;
}

constexpr const char* kDocument =
    R"({"zeta":{"z":1,"a":[1.0,1e-7,-0.0,3.4028234663852886e+38,18446744073709551615]},
"asset":{"version":"2.0","generator":"by hand \u00e4\n","extras":{"k":null}},
"nodes":[{"name":"a","extensions":{"X":{"deep":true}}},{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,5,6,7,1],"name":"b"}],
"buffers":[{"name":"first","byteLength":7}],
"bufferViews":[{"byteLength":7,"buffer":0,"byteStride":4}],
"accessors":[{"count":1,"componentType":5121,"type":"SCALAR","bufferView":0}],
"animations":[{"name":"hit","channels":[],"samplers":[]},{"name":"hit_2","channels":[],"samplers":[]}],
"scenes":[{"nodes":[0,1]}],"extensionsUsed":["X"]})";

TEST(WriteGlb, AddsAnAnimationAndLeavesEverythingElse) {
  Character character = from_json(kDocument, {{1, 2, 3, 4, 5, 6, 7}}, true, 2);
  character.document.extra_chunks = {4, 0, 0, 0, 'E', 'X', 'T', 'R', 9, 8, 7, 6};
  GltfOptions options;
  options.extras_json = R"({"marks":[{"name":"impact","time_s":0.25}]})";
  const auto bytes = write_glb(character, {}, turn_of(0), options);
  ASSERT_TRUE(bytes) << bytes.error().message();
  Glb glb = parse_glb(*bytes);
  EXPECT_EQ(Bytes(glb.bin.begin(), glb.bin.begin() + 7), character.document.buffers[0]);
  EXPECT_EQ(glb.further, character.document.extra_chunks);
  EXPECT_EQ(glb.json["buffers"][0]["byteLength"], glb.bin.size());

  ASSERT_EQ(glb.json["animations"].size(), 3u);
  const Json added = glb.json["animations"][2];
  EXPECT_EQ(added["name"], "hit_3");
  EXPECT_EQ(added["extras"]["marks"][0]["time_s"], 0.25);
  const auto tracks = tracks_of(glb.json, glb.bin, added);
  ASSERT_EQ(tracks.size(), 1u);
  EXPECT_EQ(tracks[0].times, (std::vector<double>{0, 0.5}));
  EXPECT_NEAR(tracks[0].values[4], std::sqrt(0.5), 1e-7);

  glb.json["animations"].erase(2);
  while (glb.json["accessors"].size() > 1) glb.json["accessors"].erase(1);
  while (glb.json["bufferViews"].size() > 1) glb.json["bufferViews"].erase(1);
  glb.json["buffers"][0]["byteLength"] = 7;
  EXPECT_EQ(glb.json.dump(), Json::parse(kDocument).dump()) << "values, keys and their order";
}

TEST(WriteGlb, GivesAnAnimatedMatrixNodeItsParts) {
  Character character = from_json(kDocument, {{1, 2, 3, 4, 5, 6, 7}}, true, 2);
  character.skeleton.nodes[1].rest.translation = Vec3(5, 6, 7);
  const auto bytes = write_glb(character, {}, turn_of(1), {});
  ASSERT_TRUE(bytes);
  const Json node = parse_glb(*bytes).json["nodes"][1];
  EXPECT_FALSE(node.contains("matrix"));
  EXPECT_EQ(node["translation"], Json::parse("[5.0,6.0,7.0]"));
  EXPECT_EQ(node["rotation"], Json::parse("[0.0,0.0,0.0,1.0]"));
  EXPECT_EQ(node["name"], "b");
}

TEST(WriteGlb, MakesBuffersAndAnimationsWhereThereAreNone) {
  const test::Puppet puppet = test::make_puppet();
  const Skeleton& skeleton = puppet.character.skeleton;
  const Clip clip = test::falling_clip(skeleton);
  const ReducedClip reduced = reduce_keys(skeleton, clip, {}, {});
  const auto bytes = write_glb(puppet.character, puppet.humanoid, reduced, {});
  ASSERT_TRUE(bytes) << bytes.error().message();
  const Glb glb = parse_glb(*bytes);
  const auto tracks = tracks_of(glb.json, glb.bin, glb.json["animations"][0]);
  EXPECT_EQ(tracks.size(), reduced.tracks.size());
  EXPECT_LT(test::largest_distance_m(skeleton, clip, tracks, {}), 0.0005 + 2e-6);
  EXPECT_EQ(glb.json["nodes"].size(), skeleton.nodes.size()) << "a glTF source gets no further nodes";
}

TEST(WriteGlb, SharesEqualKeyTimes) {
  const test::Puppet puppet = test::make_puppet();
  const Clip clip = test::falling_clip(puppet.character.skeleton, 31);
  const ReducedClip all = reduce_keys(puppet.character.skeleton, clip, {}, {false, 0.0});
  const Glb glb = parse_glb(*write_glb(puppet.character, puppet.humanoid, all, {}));
  EXPECT_EQ(glb.json["accessors"].size(), all.tracks.size() + 1);
}

class InFolder : public testing::Test {
 protected:
  InFolder()
      : folder_(fs::temp_directory_path() /
                (std::string("ukemi_") + testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_);
  }
  ~InFolder() override { fs::remove_all(folder_); }

  /// Two buffers and an image in files of their own.
  Character linked() {
    const Bytes png{0x89, 'P', 'N', 'G', 1, 2, 3};
    EXPECT_TRUE(write_file(folder_ / "skin colour.png", png));
    Character character = from_json(R"({"asset":{"version":"2.0"},"nodes":[{"name":"a"}],
"buffers":[{"uri":"a.bin","byteLength":6},{"uri":"b.bin","byteLength":8}],
"bufferViews":[{"buffer":0,"byteOffset":1,"byteLength":5},{"buffer":1,"byteLength":8},{"buffer":1,"byteOffset":4,"byteLength":4}],
"images":[{"uri":"skin%20colour.png"},{"name":"in text","uri":"data:image/png;base64,iVBORwE="}]})",
                                    {{0, 1, 2, 3, 4, 5}, {10, 11, 12, 13, 14, 15, 16, 17}}, false, 1);
    character.path = folder_ / "source.gltf";
    character.document.folder = folder_;
    return character;
  }

  fs::path folder_;
};

using WriteGlbInFolder = InFolder;
using WriteGltfInFolder = InFolder;

TEST_F(WriteGlbInFolder, EmbedsBuffersAndImages) {
  const auto bytes = write_glb(linked(), {}, turn_of(0), {});
  ASSERT_TRUE(bytes) << bytes.error().message();
  const Glb glb = parse_glb(*bytes);
  ASSERT_EQ(glb.json["buffers"].size(), 1u);
  EXPECT_FALSE(glb.json["buffers"][0].contains("uri"));
  const auto content = [&](std::size_t view) {
    const Json& v = glb.json["bufferViews"][view];
    EXPECT_EQ(v["buffer"], 0);
    const auto first = glb.bin.begin() + v.value("byteOffset", 0);
    return Bytes(first, first + v["byteLength"].get<int>());
  };
  EXPECT_EQ(content(0), (Bytes{1, 2, 3, 4, 5}));
  EXPECT_EQ(content(1), (Bytes{10, 11, 12, 13, 14, 15, 16, 17}));
  EXPECT_EQ(content(2), (Bytes{14, 15, 16, 17}));
  const Json& image = glb.json["images"][0];
  EXPECT_FALSE(image.contains("uri"));
  EXPECT_EQ(image["mimeType"], "image/png");
  EXPECT_EQ(content(image["bufferView"]), (Bytes{0x89, 'P', 'N', 'G', 1, 2, 3}));
  EXPECT_EQ(content(glb.json["images"][1]["bufferView"]), (Bytes{0x89, 'P', 'N', 'G', 1}));
}

TEST_F(WriteGlbInFolder, NamesTheImageThatIsMissing) {
  const Character character = linked();
  fs::remove(folder_ / "skin colour.png");
  const auto bytes = write_glb(character, {}, turn_of(0), {});
  ASSERT_FALSE(bytes);
  EXPECT_NE(bytes.error().message().find("skin colour.png"), std::string::npos);
}

TEST_F(WriteGltfInFolder, KeepsLinksBesideTheSourceAndEmbedsThemElsewhere) {
  const Character character = linked();
  GltfOptions beside;
  beside.folder = folder_;
  const Json kept = Json::parse(*write_gltf(character, {}, turn_of(0), beside));
  ASSERT_EQ(kept["buffers"].size(), 3u);
  EXPECT_EQ(kept["buffers"][0]["uri"], "a.bin");
  EXPECT_EQ(kept["images"][0]["uri"], "skin%20colour.png");
  EXPECT_TRUE(
      kept["buffers"][2]["uri"].get<std::string>().starts_with("data:application/octet-stream;base64,"));
  EXPECT_EQ(kept["bufferViews"][3]["buffer"], 2);
  const Json embedded = Json::parse(*write_gltf(character, {}, turn_of(0), {}));
  EXPECT_EQ(embedded["buffers"][0]["uri"], "data:application/octet-stream;base64,AAECAwQF");
  EXPECT_EQ(embedded["buffers"][1]["uri"], "data:application/octet-stream;base64,CgsMDQ4PEBE=");
  EXPECT_EQ(embedded["images"][0]["uri"], "data:image/png;base64,iVBORwECAw==");
}

TEST(WriteGltf, TurnsTheBinaryChunkIntoADataUri) {
  const Character character = from_json(kDocument, {{1, 2, 3, 4, 5, 6, 7}}, true, 2);
  const Json json = Json::parse(*write_gltf(character, {}, turn_of(0), {}));
  ASSERT_EQ(json["buffers"].size(), 2u);
  EXPECT_EQ(json["buffers"][0]["uri"], "data:application/octet-stream;base64,AQIDBAUGBw==");
  EXPECT_EQ(json["buffers"][0]["byteLength"], 7);
  EXPECT_EQ(json["bufferViews"][0]["buffer"], 0);
  EXPECT_EQ(json["bufferViews"][1]["buffer"], 1);
}

TEST(WriteGlb, LeavesSkeletonAndAnimationOfAClipAlone) {
  Character character = from_json(kDocument, {{1, 2, 3, 4, 5, 6, 7}}, true, 2);
  GltfOptions options;
  options.clip_only = true;
  const Glb glb = parse_glb(*write_glb(character, {}, turn_of(0), options));
  EXPECT_EQ(glb.json["animations"].size(), 1u);
  EXPECT_EQ(glb.json["accessors"].size(), 2u);
  EXPECT_EQ(glb.json["nodes"][0],
            Json::parse(R"({"name":"a","extras":{"ukemi":{"left_out":"extensions"}}})"));
  EXPECT_FALSE(glb.json.contains("extensionsUsed"));
  EXPECT_EQ(tracks_of(glb.json, glb.bin, glb.json["animations"][0]).size(), 1u);
}

TEST(WriteGlb, KeepsTheSkinsOfAClipAloneSoThatItsNodesAreBones) {
  Character character = from_json(R"({"asset":{"version":"2.0"},
"nodes":[{"name":"hip","children":[1]},{"name":"tip"},{"name":"skin","mesh":0,"skin":0},{"name":"hat","mesh":1,"extras":5}],
"meshes":[{"primitives":[]},{"primitives":[]}],
"skins":[{"name":"low","joints":[0,1],"inverseBindMatrices":0},{"name":"high","joints":[0,1],"skeleton":0,"inverseBindMatrices":1}]})",
                                  {{}}, true, 4);
  Affine moved = Affine::Identity();
  moved.translation() = Vec3(0, -2, 0);
  character.skins = {{{0, 1}, {Affine::Identity(), Affine::Identity()}},
                     {{0, 1}, {Affine::Identity(), moved}}};
  GltfOptions options;
  options.clip_only = true;
  const Glb glb = parse_glb(*write_glb(character, {}, turn_of(0), options));
  ASSERT_EQ(glb.json["skins"].size(), 1u) << "one of those with the same joints";
  const Json& skin = glb.json["skins"][0];
  EXPECT_EQ(skin["name"], "high");
  EXPECT_EQ(skin["joints"], Json::parse("[0,1]"));
  EXPECT_EQ(skin["skeleton"], 0);
  const auto matrices = floats_of(glb.json, glb.bin, skin["inverseBindMatrices"]);
  ASSERT_EQ(matrices.size(), 32u);
  EXPECT_EQ(matrices[16 + 13], -2.0f);
  EXPECT_FALSE(glb.json.contains("meshes"));
  EXPECT_EQ(glb.json["nodes"][1], Json::parse(R"({"name":"tip"})"));
  EXPECT_EQ(glb.json["nodes"][2], Json::parse(R"({"name":"skin","extras":{"ukemi":{"left_out":"mesh"}}})"));
  EXPECT_EQ(glb.json["nodes"][3], Json::parse(R"({"name":"hat","extras":5})"));
}

TEST(WriteGlb, MakesBonesOfTheNodesOfAClipAloneWhereTheSourceHadNoSkin) {
  for (const SourceFormat format : {SourceFormat::bvh, SourceFormat::assimp, SourceFormat::gltf}) {
    Character character = from_json(R"({"asset":{"version":"2.0"},
"nodes":[{"name":"hip","children":[1]},{"name":"tip"}]})",
                                    {{}}, true, 2);
    character.format = format;
    GltfOptions options;
    options.clip_only = true;
    const Glb glb = parse_glb(*write_glb(character, {}, turn_of(0), options));
    EXPECT_EQ(glb.json.contains("skins"), format != SourceFormat::gltf);
    if (format == SourceFormat::gltf) continue;
    EXPECT_EQ(glb.json["skins"][0]["joints"], Json::parse("[0,1]"));
  }
}

TEST(WriteGlb, RefusesADocumentThatIsNotTheSkeletons) {
  EXPECT_FALSE(write_glb(from_json("{\"nodes\":[]}", {}, true, 1), {}, turn_of(0), {}));
  EXPECT_FALSE(write_glb(from_json("not json", {}, true, 1), {}, turn_of(0), {}));
  EXPECT_FALSE(write_glb(from_json("[1,2]", {}, true, 1), {}, turn_of(0), {}));
  EXPECT_FALSE(write_glb(from_json(R"({"nodes":[{}],"buffers":7})", {}, false, 1), {}, turn_of(3), {}));
  EXPECT_FALSE(write_glb(from_json(R"({"nodes":[{}],"bufferViews":[{"buffer":9}]})", {}, false, 1), {},
                         turn_of(0), {}));
}

constexpr const char* kBvh = R"(HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Chest
  {
    OFFSET 0 40 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 30 0
    }
  }
}
MOTION
Frames: 1
Frame Time: 0.0333333
0 90 0 0 0 0 0 0 0
)";

/// World transforms of the document's nodes, rest pose.
std::vector<Affine> world_of(const Json& json) {
  Skeleton skeleton;
  for (const Json& node : json["nodes"]) {
    Node n;
    const auto numbers = [&](const char* key, std::vector<double> otherwise) {
      return node.value(key, otherwise);
    };
    const auto t = numbers("translation", {0, 0, 0});
    const auto r = numbers("rotation", {0, 0, 0, 1});
    const auto s = numbers("scale", {1, 1, 1});
    n.rest = {{t[0], t[1], t[2]}, Quat(r[3], r[0], r[1], r[2]), {s[0], s[1], s[2]}};
    skeleton.nodes.push_back(n);
  }
  for (int i = 0; i < skeleton.size(); ++i)
    for (const int child : json["nodes"][i].value("children", std::vector<int>()))
      skeleton.nodes[child].parent = i;
  EXPECT_TRUE(skeleton.sort());
  return world_transforms(skeleton, rest_pose(skeleton));
}

TEST(WriteGlb, ShowsABvhAsAFigureInMetres) {
  Diagnostics diagnostics;
  const auto character = read_bvh(kBvh, "walk.bvh", diagnostics);
  ASSERT_TRUE(character);
  Humanoid humanoid;
  humanoid.world_from_file = {0.01, exp_rotation(Vec3(-kPi / 2, 0, 0)), Vec3::Zero()};
  humanoid.reference = rest_pose(character->skeleton);
  humanoid.reference[0].rotation = exp_rotation(Vec3(0, 0, 1));
  const Glb glb = parse_glb(*write_glb(*character, humanoid, turn_of(1), {}));
  const Json& json = glb.json;
  ASSERT_EQ(json["nodes"].size(), 4u);
  EXPECT_EQ(json["nodes"][2]["name"], "walk") << "of the file";
  EXPECT_EQ(json["nodes"][2]["children"], Json::parse("[0]"));
  EXPECT_EQ(json["scenes"][0]["nodes"], Json::parse("[2,3]"));
  const auto world = world_of(json);
  EXPECT_LT((world[1].translation() - Vec3(0, 0, -0.4)).norm(), 1e-12);

  // Skinned by hand in the reference pose, every vertex lies where the file's world puts it.
  const Json& skin = json["skins"][0];
  const auto binds = floats_of(json, glb.bin, skin["inverseBindMatrices"]);
  const auto bind = world_transforms(character->skeleton, humanoid.reference);
  for (std::size_t j = 0; j < 2; ++j) {
    Eigen::Matrix4f inverse;
    std::copy_n(binds.begin() + static_cast<std::ptrdiff_t>(16 * j), 16, inverse.data());
    EXPECT_LT((bind[j].matrix() * inverse.cast<double>() - Eigen::Matrix4d::Identity()).norm(), 1e-5);
  }
  const Json& primitive = json["meshes"][0]["primitives"][0];
  const auto points = floats_of(json, glb.bin, primitive["attributes"]["POSITION"]);
  EXPECT_EQ(points.size(), 2u * 8 * 3 * 3) << "two bones of eight triangles";
  const auto normals = floats_of(json, glb.bin, primitive["attributes"]["NORMAL"]);
  const Vec3 middle = bind[0] * Vec3(0, 8, 0);
  for (std::size_t v = 0; v < 24; ++v) {
    const Vec3 p(points[3 * v], points[3 * v + 1], points[3 * v + 2]);
    const Vec3 n(normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]);
    EXPECT_GT(n.dot(p - middle), 0.0) << "normals point outwards";
  }
}

TEST(StickMesh, HasNoSpikeFromTheSceneToTheHipsAndNoSlivers) {
  Character character;
  const auto add = [&](const char* name, int parent, const Vec3& place) {
    Node node;
    node.name = name;
    node.parent = parent;
    node.rest.translation = place;
    character.skeleton.nodes.push_back(node);
  };
  add("Scene", -1, Vec3(0, 0, 0));
  add("Hips", 0, Vec3(500, 100, 0));
  add("Spine", 1, Vec3(0, 5, 0));
  add("Head", 2, Vec3(0, 60, 0));
  ASSERT_TRUE(character.skeleton.sort());
  Humanoid humanoid;
  humanoid.root = 1;
  const StickMesh mesh = make_stick_mesh(character, humanoid);
  ASSERT_FALSE(mesh.positions.empty());
  double nearest_x = 500.0, spine_width = 0.0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    nearest_x = std::min(nearest_x, static_cast<double>(mesh.positions[v].x()));
    if (mesh.nodes[v] == 1) spine_width = std::max(spine_width, std::abs(mesh.positions[v].x() - 500.0));
  }
  EXPECT_GT(nearest_x, 490.0) << "no bone from the origin";
  EXPECT_NEAR(spine_width, 0.012 * 95.0, 0.012 * 95.0 * 0.5);  // 13 % of its length would be 0.65
  EXPECT_GT(spine_width, 0.7);
}

TEST(Gltf, ShortRotationsAreReadBackAsTheRotationsThatTheyAre) {
  test::Puppet puppet = test::make_puppet();
  ReducedClip clip = turn_of(5);
  clip.short_rotations = true;
  const auto bytes = write_glb(puppet.character, puppet.humanoid, clip, {});
  ASSERT_TRUE(bytes) << bytes.error().message();
  Diagnostics diagnostics;
  const auto read = read_gltf(*bytes, "out.glb", diagnostics);
  ASSERT_TRUE(read) << read.error().message();
  const Animation& animation = read->animations.back();
  const auto turned_deg = [&](double time_s) {
    return degrees(log_rotation(sample(read->skeleton, animation, time_s)[5].rotation).x());
  };
  EXPECT_NEAR(turned_deg(0.0), 0.0, 0.01);
  EXPECT_NEAR(turned_deg(0.25), 45.0, 0.01);
  EXPECT_NEAR(turned_deg(0.5), 90.0, 0.01);
  ASSERT_EQ(animation.tracks.size(), 1u);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(Eigen::Map<const Eigen::Vector4d>(animation.tracks[0].values.data() + 4 * k).norm(), 1.0,
                1e-4);
}

}  // namespace
}  // namespace ukemi
