#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "base/files.h"
#include "gltf_builder.h"
#include "load/gltf_reader.h"
#include "support/random.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

using test::Bytes;
using test::Document;
using test::Json;
using test::read;
using test::skinned_square;

TEST(Gltf, ReadsAHandMadeGlb) {
  const Document d = skinned_square();
  const auto c = read(d.glb());
  ASSERT_TRUE(c) << c.error().message();
  EXPECT_EQ(c->name, "model");
  ASSERT_EQ(c->skeleton.size(), 3);
  EXPECT_EQ(c->skeleton.nodes[1].name, "spine");
  EXPECT_EQ(c->skeleton.nodes[1].parent, 0);
  EXPECT_EQ(c->skeleton.nodes[2].parent, -1);
  ASSERT_EQ(c->skins.size(), 1u);
  EXPECT_EQ(c->skins[0].joints, (std::vector<int>{0, 1}));
  EXPECT_EQ(Vec3(c->skins[0].inverse_bind[1].translation()), Vec3(0, -1.5, 0));
  ASSERT_EQ(c->parts.size(), 1u);
  const MeshPart& part = c->parts[0];
  EXPECT_EQ(part.node, 2);
  EXPECT_EQ(part.skin, 0);
  EXPECT_EQ(part.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(part.positions[2], Eigen::Vector3f(1, 2, 0));
  for (const auto& normal : part.normals) EXPECT_EQ(normal, Eigen::Vector3f(0, 0, 1));
  ASSERT_EQ(c->animations.size(), 1u);
  EXPECT_EQ(c->animations[0].name, "turn");
  EXPECT_EQ(c->animations[0].start_s, 0.5);
  EXPECT_EQ(c->animations[0].end_s, 2.0);
  EXPECT_LT(angle_between(sample(c->skeleton, c->animations[0], 1.0)[1].rotation, Quat(0, 0, 0, 1)), 1e-6);
}

TEST(Gltf, KeepsTheDocumentAsItIs) {
  Document d = skinned_square();
  d.json["extras"] = {{"mine", {1, 2.50}}};
  Bytes bytes = d.glb();
  const Bytes extra{4, 0, 0, 0, 'X', 'T', 'R', 'A', 1, 2, 3, 4};
  bytes.insert(bytes.end(), extra.begin(), extra.end());
  const auto size = static_cast<std::uint32_t>(bytes.size());
  std::memcpy(bytes.data() + 8, &size, 4);
  const auto c = read(bytes);
  ASSERT_TRUE(c) << c.error().message();
  EXPECT_TRUE(c->document.is_glb);
  EXPECT_EQ(c->document.folder, "folder");
  std::uint32_t json_length = 0;
  std::memcpy(&json_length, bytes.data() + 12, 4);
  EXPECT_EQ(c->document.json, std::string(bytes.begin() + 20, bytes.begin() + 20 + json_length));
  ASSERT_EQ(c->document.buffers.size(), 1u);
  EXPECT_EQ(c->document.buffers[0], d.binary);
  EXPECT_EQ(c->document.extra_chunks, extra);
}

TEST(Gltf, TextWithDataUriAndByteOrderMarkIsTheSame) {
  const Document d = skinned_square();
  const auto c = read("\xEF\xBB\xBF" + d.gltf());
  ASSERT_TRUE(c) << c.error().message();
  EXPECT_FALSE(c->document.is_glb);
  EXPECT_EQ(c->document.buffers.at(0), d.binary);
  EXPECT_EQ(c->parts.at(0).positions.size(), 4u);
}

TEST(Gltf, WeightsAreNormalisedAndBareVerticesFollowTheFirstJoint) {
  const auto c = read(skinned_square().glb());
  ASSERT_TRUE(c);
  const MeshPart& part = c->parts[0];
  EXPECT_EQ(part.weights[0], (std::array<float, 4>{0.75f, 0.25f, 0, 0}));
  EXPECT_EQ(part.weights[1], (std::array<float, 4>{0.5f, 0.5f, 0, 0}));
  EXPECT_EQ(part.joints[2], (std::array<std::uint16_t, 4>{1, 0, 0, 0}));
  EXPECT_EQ(part.weights[3], (std::array<float, 4>{1, 0, 0, 0}));
  EXPECT_EQ(part.joints[3][0], 0);
}

TEST(Gltf, TheFourStrongestOfEightInfluencesAreKept) {
  Document d = skinned_square();
  Bytes joints;
  std::vector<float> weights;
  for (int v = 0; v < 4; ++v)
    for (int k = 0; k < 4; ++k) {
      joints.push_back(static_cast<std::uint8_t>(k % 2));
      weights.push_back(k < 2 ? 1.0f : 0.0f);
    }
  auto& attributes = d.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["WEIGHTS_0"] = d.floats({.1f, .2f, .3f, .4f, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
  attributes["JOINTS_1"] = d.add(joints, 5121, "VEC4", 4);
  attributes["WEIGHTS_1"] = d.floats(weights, "VEC4", 4);
  const auto c = read(d.glb());
  ASSERT_TRUE(c) << c.error().message();
  const auto& kept = c->parts[0].weights[0];
  EXPECT_NEAR(kept[0], 1.0 / 2.7, 1e-6);
  EXPECT_NEAR(kept[2], 0.4 / 2.7, 1e-6);
  EXPECT_NEAR(kept[3], 0.3 / 2.7, 1e-6);
}

TEST(Gltf, SkinsWithoutInverseBindMatricesHaveIdentities) {
  Document d = skinned_square();
  d.json["skins"][0].erase("inverseBindMatrices");
  const auto c = read(d.glb());
  ASSERT_TRUE(c) << c.error().message();
  EXPECT_TRUE(c->skins[0].inverse_bind[1].isApprox(Affine::Identity()));
}

TEST(Gltf, StripsAndFansBecomeTriangles) {
  for (const auto& [mode, expected] :
       {std::pair{5, std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}}, {6, {0, 1, 2, 0, 2, 3}}}) {
    Document d = skinned_square();
    auto& primitive = d.json["meshes"][0]["primitives"][0];
    primitive["mode"] = mode;
    primitive.erase("indices");
    const auto c = read(d.glb());
    ASSERT_TRUE(c) << c.error().message();
    std::vector<std::uint32_t> indices = c->parts[0].indices;
    ASSERT_EQ(indices.size(), 6u);
    for (std::size_t i = 0; i < 6; i += 3)  // the same triangles up to rotation
      std::rotate(indices.begin() + i, std::find(indices.begin() + i, indices.begin() + i + 3, expected[i]),
                  indices.begin() + i + 3);
    EXPECT_EQ(indices, expected) << mode;
  }
}

TEST(Gltf, MorphDefaultsAreApplied) {
  Document d = skinned_square();
  const int offsets = d.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
  d.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", offsets}}, {{"POSITION", offsets}}};
  d.json["meshes"][0]["weights"] = {0.5, 0.25};
  EXPECT_EQ(read(d.glb())->parts[0].positions[0], Eigen::Vector3f(0, 0, 0.75f));
  d.json["nodes"][2]["weights"] = {1, 1};
  EXPECT_EQ(read(d.glb())->parts[0].positions[0], Eigen::Vector3f(0, 0, 2)) << "the node's weights win";
}

TEST(Gltf, MatrixNodesAreDecomposed) {
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    Affine expected = Affine::Identity();
    expected.translate(test::random_vector(random));
    expected.rotate(exp_rotation(3.0 * test::random_vector(random)));
    Vec3 scale = test::random_vector(random);
    scale += scale.cwiseSign() * 0.1;
    expected.scale(scale);
    const load::Decomposition parts = load::decompose(expected.matrix());
    EXPECT_LT((parts.local.affine().matrix() - expected.matrix()).norm(), 1e-12);
    EXPECT_LT(parts.shear, 1e-12);
  }
  Eigen::Matrix4d sheared = Eigen::Matrix4d::Identity();
  sheared(0, 1) = 1.0;
  EXPECT_GT(load::decompose(sheared).shear, 0.5);
}

TEST(Gltf, AnimationsKeepTheirInterpolation) {
  Document d = skinned_square();
  const int times = d.floats({0, 1}, "SCALAR", 1);
  const int steps = d.floats({1, 2, 3, 4, 5, 6}, "VEC3", 3);
  const int cubic = d.floats({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 8, 0, 0, 0, 0, 0}, "VEC3", 3);
  d.json["animations"][0]["samplers"] = {
      {{"input", times}, {"output", steps}, {"interpolation", "STEP"}},
      {{"input", times}, {"output", cubic}, {"interpolation", "CUBICSPLINE"}}};
  d.json["animations"][0]["channels"] = {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
                                         {{"sampler", 1}, {"target", {{"node", 1}, {"path", "scale"}}}},
                                         {{"sampler", 0}, {"target", {{"node", 1}, {"path", "weights"}}}},
                                         {{"sampler", 0}, {"target", {{"path", "translation"}}}}};
  const auto c = read(d.glb());
  ASSERT_TRUE(c) << c.error().message();
  ASSERT_EQ(c->animations[0].tracks.size(), 2u) << "morph weights and channels without a node move no node";
  const Pose pose = sample(c->skeleton, c->animations[0], 0.5);
  EXPECT_EQ(pose[0].translation, Vec3(1, 2, 3));
  EXPECT_DOUBLE_EQ(pose[1].scale.x(), 4.0);
}

TEST(Gltf, QuantisedRotationsAreFractions) {
  Document d = skinned_square();
  d.json["animations"][0]["samplers"][0]["output"] =
      d.add<std::int16_t>({0, 0, 0, 32767, 0, 0, 32767, 0, 0, 0, 0, 32767}, 5122, "VEC4", 4, true);
  const auto c = read(d.glb());
  ASSERT_TRUE(c) << c.error().message();
  EXPECT_EQ(c->animations[0].tracks[0].values[6], 1.0);
}

TEST(Gltf, MeshesOutsideTheSceneAreNotDrawn) {
  Document d = skinned_square();
  d.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {2}}}};
  EXPECT_TRUE(read(d.glb())->parts.empty());
  d.json["scene"] = 1;
  EXPECT_EQ(read(d.glb())->parts.size(), 1u);
}

TEST(Gltf, ReadsMaterialsAndImages) {
  Document d = skinned_square();
  const Bytes png{0x89, 'P', 'N', 'G', 1, 2, 3};
  const int view = d.view(png.data(), png.size());
  const int uvs = d.floats({0, 0, 1, 0, 1, 1, 0, 1}, "VEC2", 2);
  d.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}},
                      {{"uri", "data:image/jpeg;base64,/9j/"}}};
  d.json["textures"] = {{{"source", 1}}, {{"source", 0}}};
  d.json["materials"] = {
      {{"name", "skin"},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.25},
       {"doubleSided", true},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.5, 0.25, 1, 1}},
         {"baseColorTexture",
          {{"index", 1},
           {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"scale", {2, 1}}}}}}}}}}},
      {{"extensions",
        {{"KHR_materials_pbrSpecularGlossiness",
          {{"diffuseFactor", {0, 1, 0, 1}}, {"diffuseTexture", {{"index", 0}}}}}}}}};
  d.json["meshes"][0]["primitives"][0]["material"] = 0;
  d.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uvs;
  const auto c = read(d.glb());
  ASSERT_TRUE(c) << c.error().message();
  EXPECT_EQ(c->images[0].bytes, png);
  EXPECT_EQ(c->images[1].mime, "image/jpeg");
  EXPECT_EQ(c->materials[0].base_color, (std::array<float, 4>{0.5f, 0.25f, 1, 1}));
  EXPECT_EQ(c->materials[0].base_color_image, 0);
  EXPECT_EQ(c->materials[0].alpha, Material::Alpha::mask);
  EXPECT_EQ(c->materials[0].alpha_cutoff, 0.25f);
  EXPECT_TRUE(c->materials[0].double_sided);
  EXPECT_EQ(c->materials[1].base_color_image, 1);
  EXPECT_EQ(c->materials[1].base_color, (std::array<float, 4>{0, 1, 0, 1}));
  EXPECT_EQ(c->parts[0].material, 0);
  EXPECT_EQ(c->parts[0].uvs[2], Eigen::Vector2f(2.5f, 1));
}

TEST(Gltf, ReadsTheBonesOfBothVrmVersions) {
  Document d = skinned_square();
  d.json["extensions"]["VRM"]["humanoid"]["humanBones"] = {
      {{"bone", "hips"}, {"node", 0}}, {{"bone", "spine"}, {"node", 1}}, {{"bone", "jaw"}, {"node", -1}}};
  const std::vector<std::pair<std::string, int>> expected{{"hips", 0}, {"spine", 1}};
  EXPECT_EQ(read(d.glb())->vrm_bones, expected);
  d.json["extensions"] = {
      {"VRMC_vrm", {{"humanoid", {{"humanBones", {{"hips", {{"node", 0}}}, {"spine", {{"node", 1}}}}}}}}}};
  EXPECT_EQ(read(d.glb())->vrm_bones, expected);
}

TEST(Gltf, AFileWithoutMeshAndSkinLoads) {
  Document d;
  d.json["nodes"] = {{{"name", "a"}}};
  const auto c = read(d.glb());
  ASSERT_TRUE(c) << c.error().message();
  EXPECT_TRUE(c->parts.empty());
}

TEST(Gltf, DecodesDraco) {
  Document d = skinned_square();
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position_id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int joint_id = builder.AddAttribute(draco::GeometryAttribute::GENERIC, 4, draco::DT_UINT8);
  const int weight_id = builder.AddAttribute(draco::GeometryAttribute::GENERIC, 4, draco::DT_UINT8);
  const std::array<float, 3> corners[4]{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}};
  const std::array<std::uint8_t, 4> joints{1, 0, 0, 0};
  const std::array<std::uint8_t, 4> weights{255, 0, 0, 0};
  const int faces[2][3]{{0, 1, 2}, {0, 2, 3}};
  for (int f = 0; f < 2; ++f) {
    const draco::FaceIndex face(static_cast<std::uint32_t>(f));
    builder.SetAttributeValuesForFace(position_id, face, corners[faces[f][0]].data(),
                                      corners[faces[f][1]].data(), corners[faces[f][2]].data());
    builder.SetAttributeValuesForFace(joint_id, face, joints.data(), joints.data(), joints.data());
    builder.SetAttributeValuesForFace(weight_id, face, weights.data(), weights.data(), weights.data());
  }
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer encoded;
  ASSERT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &encoded).ok());
  const int view = d.view(encoded.data(), encoded.size());
  const int position = d.accessor({{"componentType", 5126}, {"count", mesh->num_points()}, {"type", "VEC3"}});
  const int joint = d.accessor({{"componentType", 5121}, {"count", mesh->num_points()}, {"type", "VEC4"}});
  const int weight = d.accessor(
      {{"componentType", 5121}, {"count", mesh->num_points()}, {"type", "VEC4"}, {"normalized", true}});
  auto& primitive = d.json["meshes"][0]["primitives"][0];
  primitive["attributes"] = {{"POSITION", position}, {"JOINTS_0", joint}, {"WEIGHTS_0", weight}};
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view},
      {"attributes",
       {{"POSITION", mesh->attribute(position_id)->unique_id()},
        {"JOINTS_0", mesh->attribute(joint_id)->unique_id()},
        {"WEIGHTS_0", mesh->attribute(weight_id)->unique_id()}}}};
  const auto c = read(d.glb());
  ASSERT_TRUE(c) << c.error().message();
  const MeshPart& part = c->parts.at(0);
  EXPECT_EQ(part.positions.size(), 4u);
  EXPECT_EQ(part.indices.size(), 6u);
  Eigen::Vector3f top = part.positions[0];
  for (const auto& p : part.positions) top = top.cwiseMax(p);
  EXPECT_LT((top - Eigen::Vector3f(1, 2, 0)).norm(), 1e-2f);
  EXPECT_EQ(part.weights[0], (std::array<float, 4>{1, 0, 0, 0}));
  EXPECT_EQ(part.joints[0][0], 1);

  primitive["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = 0;
  const auto broken = read(d.glb());
  ASSERT_FALSE(broken);
  EXPECT_NE(broken.error().what.find("KHR_draco_mesh_compression cannot be decoded"), std::string::npos);
}

struct Refusal {
  const char* pointer;
  Json value;
  std::string what;
};

TEST(Gltf, RefusesWithThePlaceInTheDocument) {
  const std::vector<Refusal> refusals{
      {"/asset/version", "1.0", "asset.version is '1.0', but 2.0 is needed"},
      {"/extensionsRequired",
       {"KHR_mesh_quantization", "ACME_magic"},
       "extensionsRequired[1] is 'ACME_magic'"},
      {"/nodes/1/children", {0}, "a node is its own ancestor"},
      {"/nodes/1/children", {1}, "nodes[1].children[0] is a child of nodes[0] already"},
      {"/nodes/1/children", {9}, "nodes[1].children[0] is 9, but there are 3 nodes"},
      {"/nodes/1/rotation", {0, 0, 0, 0}, "nodes[1].rotation has length 0, not 1"},
      {"/nodes/1/rotation", {0, 0, 1}, "nodes[1].rotation has 3 numbers, not 4"},
      {"/nodes/1/translation", {0, "x", 1}, "nodes[1].translation[1] is not a number"},
      {"/nodes/1/matrix",
       {1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
       "nodes[1].matrix is no translation"},
      {"/nodes/2/mesh", 1, "nodes[2].mesh is 1, but there are 1 meshes"},
      {"/nodes/2/skin", -1, "nodes[2].skin is -1, but there are 1 skins"},
      {"/nodes/1/name", 3, "nodes[1].name is not a string"},
      {"/nodes", "x", "nodes is not an array"},
      {"/nodes", Json::array(), "has no nodes"},
      {"/scene", 1, "scene is 1, but there are 1 scenes"},
      {"/scenes/0/nodes/0", 7, "scenes[0].nodes[0] is 7"},
      {"/skins/0/joints", Json::array(), "skins[0].joints has 0 joints"},
      {"/skins/0/joints", {0, 5}, "skins[0].joints[1] is 5"},
      {"/skins/0/joints", {0, 1, 2}, "skins[0] has 3 joints, but accessors[4] has 2 matrices"},
      {"/skins/0/inverseBindMatrices", 0, "accessors[0].type has 3 components, but 16 are needed"},
      {"/meshes/0/primitives/0/attributes/POSITION", 99,
       "attributes.POSITION is 99, but there are 7 accessors"},
      {"/meshes/0/primitives/0/attributes/NORMAL", 4,
       "accessors[4].type has 16 components, but 3 are needed"},
      {"/meshes/0/primitives/0/attributes/JOINTS_0", 2, "accessors[2].componentType is 5126, but unsigned"},
      {"/meshes/0/primitives/0/indices", 0, "accessors[0].componentType is 5126, but unsigned"},
      {"/accessors/0/count", 3, "meshes[0].primitives[0] has index 5 = 3, but there are 3 vertices"},
      {"/accessors/3/count", 5, "has 5 indices, which is no multiple of 3"},
      {"/accessors/2/count", 3, "attributes.WEIGHTS_0 has 3 vertices, but POSITION has 4"},
      {"/meshes/0/primitives/0/material", 0, "material is 0, but there are 0 materials"},
      {"/meshes/0/primitives/0/mode", 9, "mode is 9, outside 0 to 6"},
      {"/animations/0/channels/0/sampler", 4, "animations[0].channels[0].sampler is 4"},
      {"/animations/0/channels/0/target/node", 44, "animations[0].channels[0].target.node is 44"},
      {"/animations/0/channels/0/target/path", "spin", "target.path is 'spin'"},
      {"/animations/0/samplers/0/interpolation", "BEZIER", "interpolation is 'BEZIER'"},
      {"/animations/0/samplers/0/interpolation", "CUBICSPLINE",
       "has 3 elements, but 9 are needed for 3 keys"},
      {"/animations/0/samplers/0/input", 6, "accessors[6].type has 4 components, but 1 are needed"},
      {"/accessors/6/count", 2, "output (accessors[6]) has 2 elements, but 3 are needed for 3 keys"},
      {"/buffers", {{{"byteLength", 100000}}}, "buffers[0] announces 100000 bytes and has"},
      {"/extensions",
       {{"VRM", {{"humanoid", {{"humanBones", {{{"bone", "hips"}, {"node", 3}}}}}}}}},
       "node is 3, but"},
  };
  for (const Refusal& refusal : refusals) {
    Document d = skinned_square();
    d.json[Json::json_pointer(refusal.pointer)] = refusal.value;
    const auto c = read(d.glb());
    ASSERT_FALSE(c) << refusal.what;
    EXPECT_EQ(c.error().kind, ErrorKind::input);
    EXPECT_EQ(c.error().file, "folder/model.glb");
    EXPECT_NE(c.error().what.find(refusal.what), std::string::npos)
        << c.error().what << "\nnot: " << refusal.what;
    EXPECT_FALSE(c.error().fix.empty());
  }
}

TEST(Gltf, RefusesJointsBeyondTheSkinNegativeWeightsAndTimesThatStandStill) {
  Document beyond = skinned_square();
  beyond.binary[beyond.json["bufferViews"][1]["byteOffset"]] = 2;
  EXPECT_NE(read(beyond.glb()).error().what.find("binds vertex 0 to joint 2, but skins[0] has 2 joints"),
            std::string::npos);
  Document negative = skinned_square();
  const float weight = -0.5f;
  std::memcpy(negative.binary.data() + negative.json["bufferViews"][2]["byteOffset"].get<int>(), &weight, 4);
  EXPECT_NE(read(negative.glb()).error().what.find("negative weight -0.5"), std::string::npos);
  Document still = skinned_square();
  const float time = 0.5f;
  std::memcpy(still.binary.data() + still.json["bufferViews"][5]["byteOffset"].get<int>() + 4, &time, 4);
  EXPECT_NE(
      read(still.glb()).error().what.find("animations[0].samplers[0].input (accessors[5]): time 1 is 0.5 s"),
      std::string::npos)
      << read(still.glb()).error().what;
}

TEST(Gltf, AThousandNodesInARowAreReadMoreRefused) {
  for (const int count : {1000, 1001}) {
    Document d;
    for (int i = 0; i < count; ++i) {
      d.json["nodes"].push_back({{"name", "n"}});
      if (i > 0) d.json["nodes"][static_cast<std::size_t>(i - 1)]["children"] = {i};
    }
    const auto c = read(d.gltf());
    ASSERT_EQ(static_cast<bool>(c), count == 1000);
    if (!c) {
      EXPECT_EQ(c.error().what, "nodes[1000] is nested deeper than 1000");
    }
  }
}

TEST(Gltf, AClipLongerThanADayIsRefused) {
  Document d = skinned_square();
  d.json["animations"][0]["samplers"][0]["input"] = d.floats({0.0f, 1.0f, 86500.0f}, "SCALAR", 1);
  const auto c = read(d.glb());
  ASSERT_FALSE(c);
  EXPECT_NE(c.error().what.find("the last time is 86500 s, later than a day"), std::string::npos)
      << c.error().what;
}

TEST(Gltf, SyntaxErrorsHaveLineAndColumn) {
  const auto c = read("{\n \"asset\": {\"version\": \"2.0\"},\n \"nodes\": [ {} {} ]\n}");
  ASSERT_FALSE(c);
  EXPECT_EQ(c.error().line, 3);
  EXPECT_EQ(c.error().column, 16);
  EXPECT_EQ(c.error().what.substr(0, 18), "JSON: syntax error");
  const auto huge = read("{\"asset\":{\"version\":\"2.0\"},\n\"nodes\":[{\"translation\":[1e999,0,0]}]}");
  ASSERT_FALSE(huge);
  EXPECT_EQ(huge.error().line, 2);
  EXPECT_NE(read("{\"a\":" + std::string(100000, '[')).error().what.find("nested deeper"), std::string::npos);
  EXPECT_FALSE(read("{\"asset\":{\"version\":\"2.0\xFF\"}}")) << "not UTF-8";
}

TEST(Gltf, RefusesBrokenGlbHeadersAndChunks) {
  const Bytes good = skinned_square().glb();
  const auto with_word = [&](std::size_t offset, std::uint32_t word) {
    Bytes bytes = good;
    std::memcpy(bytes.data() + offset, &word, 4);
    const auto c = read(bytes);
    return c ? std::string("loads") : c.error().what;
  };
  EXPECT_NE(with_word(0, 0).find("is no glTF"), std::string::npos);
  EXPECT_EQ(with_word(4, 1), "GLB header: version 1, but only 2 is known");
  EXPECT_EQ(with_word(8, 100000),
            fmt::format("GLB header: announces 100000 bytes, the file has {}", good.size()));
  EXPECT_EQ(with_word(8, 11), fmt::format("GLB header: announces 11 bytes, the file has {}", good.size()));
  EXPECT_NE(with_word(8, 100).find("GLB chunk 0 at byte 12: announces"), std::string::npos);
  EXPECT_EQ(with_word(12, 0xFFFFFFFF),
            fmt::format("GLB chunk 0 at byte 12: announces 4294967295 bytes, {} are left", good.size() - 20));
  EXPECT_EQ(with_word(16, 0x004E4942), "GLB: the first chunk is not JSON");
  for (std::size_t length = 0; length < good.size(); ++length)
    ASSERT_FALSE(read(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)))) << length;
}

TEST(Gltf, BytesAfterTheEndOfAGlbAreLeftOutWithAWarning) {
  Bytes bytes = skinned_square().glb();
  const auto whole = read(bytes);
  bytes.insert(bytes.end(), {1, 2, 3});
  Diagnostics diagnostics;
  const auto longer = read_gltf(bytes, "a.glb", diagnostics);
  ASSERT_TRUE(longer);
  EXPECT_EQ(longer->document.json, whole->document.json);
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_EQ(diagnostics.warnings()[0].what, "has 3 bytes after its announced end; they are left out");
}

TEST(Gltf, ABufferWithoutDataIsRefusedOnlyWhereItIsRead) {
  const std::string unread = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":12}],
    "bufferViews":[{"buffer":0,"byteLength":12}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":1,"type":"VEC3"}],"nodes":[{"mesh":0}])";
  EXPECT_TRUE(read(unread + R"(,"meshes":[{"primitives":[{"attributes":{},"mode":4}]}]})"));
  EXPECT_EQ(
      read(unread + R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":4}]}]})").error().what,
      "bufferViews[0] lies in buffers[0], which has no data");
}

TEST(Gltf, ChangedBytesNeverCrash) {
  Random random(1);
  const Bytes good = skinned_square().glb();
  int loaded = 0;
  for (int i = 0; i < 3000; ++i) {
    Bytes bytes = good;
    for (int k = 0; k < 1 + i % 3; ++k)
      bytes[12 + test::random_below(random, bytes.size() - 12)] = static_cast<std::uint8_t>(random.next());
    loaded += read(bytes) ? 1 : 0;
  }
  EXPECT_GT(loaded, 100) << "changed floats are still a model";
  EXPECT_LT(loaded, 2900) << "changed JSON is refused";
}

class GltfFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "ukemi_gltf_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder = pattern;
    fs::create_directories(folder / "model" / "a b");
  }
  void TearDown() override { fs::remove_all(folder); }

  Result<Character> load_with_uri(const std::string& uri, const char* buffers_or_images = "buffers") {
    Document d = skinned_square();
    EXPECT_TRUE(write_file(folder / "model" / "a b" / "c%.bin", d.binary));
    EXPECT_TRUE(write_file(folder / "outside.bin", d.binary));
    if (std::string(buffers_or_images) == "images") {
      d.json["images"] = {{{"uri", uri}}};
      d.json["buffers"] = {{{"byteLength", d.binary.size()}, {"uri", "a%20b/c%25.bin"}}};
    } else {
      d.json["buffers"] = {{{"byteLength", d.binary.size()}, {"uri", uri}}};
    }
    EXPECT_TRUE(write_file(folder / "model" / "m.gltf", d.json.dump()));
    warnings = Diagnostics();
    return load_character(folder / "model" / "m.gltf", {}, warnings);
  }
  fs::path folder;
  Diagnostics warnings;
};

TEST_F(GltfFiles, BuffersBesideTheDocumentAreRead) {
  const auto c = load_with_uri("a%20b/c%25.bin");
  ASSERT_TRUE(c) << c.error().message();
  EXPECT_EQ(c->document.buffers[0], skinned_square().binary);
  EXPECT_TRUE(load_with_uri("./a b/c%.bin")) << "unescaped names are common";
}

TEST_F(GltfFiles, UrisThatLeaveTheFolderAreRefused) {
  const std::string absolute = (folder / "outside.bin").string();
  for (const std::string& uri :
       {std::string("../outside.bin"), std::string("..%2Foutside.bin"), std::string("a b/../../outside.bin"),
        absolute, "file://" + absolute, std::string("http://example.com/a.bin"),
        std::string("..\\outside.bin"), std::string("C:/outside.bin"), std::string("")}) {
    for (const char* kind : {"buffers", "images"}) {
      const auto c = load_with_uri(uri, kind);
      ASSERT_FALSE(c) << uri;
      EXPECT_NE(c.error().what.find(std::string(kind) + "[0].uri is '" + uri.substr(0, 5)), std::string::npos)
          << c.error().what;
      EXPECT_NE(c.error().what.find("not a file beside the document"), std::string::npos) << c.error().what;
    }
  }
}

TEST_F(GltfFiles, LinksThatLeaveTheFolderAreRefused) {
  fs::create_symlink(folder / "outside.bin", folder / "model" / "link.bin");
  for (const char* kind : {"buffers", "images"}) {
    const auto c = load_with_uri("link.bin", kind);
    ASSERT_FALSE(c) << kind;
    EXPECT_NE(c.error().what.find("not a file beside the document"), std::string::npos) << c.error().what;
  }
}

TEST_F(GltfFiles, AMissingBufferIsAnErrorAndAMissingImageAWarning) {
  const auto c = load_with_uri("none.bin");
  ASSERT_FALSE(c);
  EXPECT_NE(c.error().what.find("buffers[0].uri"), std::string::npos);
  EXPECT_NE(c.error().what.find("none.bin"), std::string::npos);
  const auto image = load_with_uri("none.png", "images");
  ASSERT_TRUE(image) << image.error().message();
  ASSERT_EQ(warnings.warnings().size(), 1u);
  EXPECT_NE(warnings.warnings()[0].what.find("images[0]: its file 'none.png'"), std::string::npos);
  EXPECT_FALSE(load_with_uri("a%2").operator bool());
  EXPECT_FALSE(load_with_uri("data:application/octet-stream;base64,A*==").operator bool());
  EXPECT_FALSE(load_with_uri("data:application/octet-stream").operator bool());
}

TEST_F(GltfFiles, LoadRefusesWhatIsNoCharacterFile) {
  Diagnostics diagnostics;
  EXPECT_TRUE(write_file(folder / "empty.glb", std::string_view()));
  EXPECT_TRUE(write_file(folder / "notes.txt", std::string_view("hello")));
  EXPECT_TRUE(write_file(folder / "bare", std::string_view("hello")));
  const auto what = [&](const fs::path& name) {
    const auto c = load_character(folder / name, {}, diagnostics);
    return c ? std::string("loads") : c.error().what;
  };
  EXPECT_EQ(what("empty.glb"), "is empty");
  EXPECT_EQ(what("notes.txt"), "extension '.txt' is not known");
  EXPECT_EQ(what("bare"), "has no extension");
  EXPECT_EQ(what("."), "is a directory");
  EXPECT_NE(what("none.glb").find("cannot read"), std::string::npos);
  EXPECT_NE(
      load_character(folder / "notes.txt", {.max_file_bytes = 3}, diagnostics).error().what.find("limit"),
      std::string::npos);
}

TEST(Gltf, FiveMegabytesAreReadQuickly) {
  Document d = skinned_square();
  constexpr std::size_t kVertices = 80000;
  std::vector<float> positions(3 * kVertices);
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = static_cast<float>(i % 977);
  std::vector<float> weights(4 * kVertices, 0.25f);
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i + 2 < kVertices; ++i) indices.insert(indices.end(), {i, i + 1, i + 2});
  auto& primitive = d.json["meshes"][0]["primitives"][0];
  primitive["attributes"] = {{"POSITION", d.floats(positions, "VEC3", 3)},
                             {"JOINTS_0", d.add(Bytes(4 * kVertices, 1), 5121, "VEC4", 4)},
                             {"WEIGHTS_0", d.floats(weights, "VEC4", 4)}};
  primitive["indices"] = d.add(indices, 5125, "SCALAR", 1);
  const Bytes bytes = d.glb();
  EXPECT_GT(bytes.size(), 3'000'000u);
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(read(bytes));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  RecordProperty("seconds", std::to_string(took.count()));
  EXPECT_LT(took.count(), 5.0);
}

}  // namespace
}  // namespace ukemi
