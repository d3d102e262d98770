// FBX and DAE: small files as text, checked through the document that the loader writes for them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "load/load.h"

namespace ukemi {
namespace {

using Json = nlohmann::json;

Result<Character> read(const std::string& text, const char* path) {
  Diagnostics diagnostics;
  return read_with_assimp({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, path,
                          diagnostics);
}

/// Centimetres and z up: a joint with a child, one triangle if asked for, and a turn of the child.
std::string dae(bool with_mesh) {
  const std::string mesh = R"(<library_geometries><geometry id="g" name="g"><mesh>
    <source id="p"><float_array id="pa" count="9">0 0 0 100 0 0 0 0 200</float_array><technique_common>
    <accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
    <param name="Z" type="float"/></accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
    </mesh></geometry></library_geometries>)";
  const std::string animation = R"(<library_animations><animation id="a"><source id="t">
    <float_array id="ta" count="3">0 0.5 1</float_array><technique_common><accessor source="#ta" count="3">
    <param name="TIME" type="float"/></accessor></technique_common></source><source id="o">
    <float_array id="oa" count="3">0 90 0</float_array><technique_common><accessor source="#oa" count="3">
    <param name="ANGLE" type="float"/></accessor></technique_common></source>
    <sampler id="s"><input semantic="INPUT" source="#t"/><input semantic="OUTPUT" source="#o"/></sampler>
    <channel source="#s" target="child/r.ANGLE"/></animation></library_animations>)";
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
    <asset><unit meter="0.01" name="centimeter"/><up_axis>Z_UP</up_axis></asset>)" +
         (with_mesh ? mesh : "") + animation +
         R"(<library_visual_scenes><visual_scene id="scene"><node id="hips" name="hips" type="JOINT">
    <translate>0 0 100</translate><node id="child" name="child" type="JOINT"><translate>0 0 50</translate>
    <rotate sid="r">0 0 1 0</rotate></node>)" +
         (with_mesh ? R"(<node id="m" name="m"><instance_geometry url="#g"/></node>)" : "") +
         R"(</node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#scene"/></scene></COLLADA>)";
}

TEST(Assimp, DaeComesInMetresAndYUp) {
  const auto c = read(dae(true), "folder/figure.DAE");
  ASSERT_TRUE(c) << c.error().message();
  EXPECT_EQ(c->format, SourceFormat::assimp);
  EXPECT_EQ(c->name, "figure");
  EXPECT_EQ(c->metres_per_unit, 1.0);
  EXPECT_TRUE(c->yup_from_file->isApprox(Quat::Identity()));
  const int child = c->skeleton.find("child");
  ASSERT_GE(child, 0);
  const Affine world = world_transforms(c->skeleton, rest_pose(c->skeleton))[child];
  EXPECT_LT((world.translation() - Vec3(0, 1.5, 0)).norm(), 1e-6);
  ASSERT_EQ(c->parts.size(), 1u);
  EXPECT_EQ(c->parts[0].positions.size(), 3u);
  EXPECT_EQ(c->parts[0].normals.size(), 3u);
  ASSERT_EQ(c->animations.size(), 1u);
  EXPECT_EQ(c->animations[0].end_s, 1.0);
  const Pose turned = sample(c->skeleton, c->animations[0], 0.5);
  EXPECT_NEAR(angle_between(turned[child].rotation, Quat::Identity()), radians(90), 1e-5);
}

TEST(Assimp, ADaeSceneWithoutANameIsCalledLikeTheFile) {
  std::string text = dae(true);
  text.replace(text.find(R"(<visual_scene id="scene">)"), 25, R"(<visual_scene id="" name="">)");
  text.replace(text.find(R"(url="#scene")"), 12, R"(url="#")");
  const auto c = read(text, "folder/figure.dae");
  ASSERT_TRUE(c) << c.error().message();
  EXPECT_EQ(c->skeleton.nodes.front().name, "figure");
}

TEST(Assimp, NodesOfTheDocumentAreThoseOfTheSkeleton) {
  const auto c = read(dae(true), "figure.dae");
  ASSERT_TRUE(c) << c.error().message();
  const Json document = Json::parse(c->document.json);
  ASSERT_EQ(document["nodes"].size(), c->skeleton.nodes.size());
  for (int i = 0; i < c->skeleton.size(); ++i) {
    EXPECT_EQ(document["nodes"][i]["name"], c->skeleton.nodes[i].name);
    EXPECT_LT(c->skeleton.nodes[i].parent, i) << "depth first: parents come before their children";
  }
  ASSERT_EQ(c->document.buffers.size(), 1u);
  EXPECT_EQ(document["buffers"][0]["byteLength"], c->document.buffers[0].size());
  EXPECT_EQ(document["accessors"][0]["max"], Json({100.0, 0.0, 200.0}));
}

TEST(Assimp, AFileWithoutMeshesGetsNone) {
  const auto c = read(dae(false), "figure.dae");
  ASSERT_TRUE(c) << c.error().message();
  EXPECT_TRUE(c->parts.empty());
  EXPECT_GE(c->skeleton.find("hips"), 0);
}

/// A text FBX with one limb and a triangle; the axes are given as index and sign of up, front and right.
std::string fbx(const std::string& settings) {
  return "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\n FBXHeaderVersion: 1003\n FBXVersion: 7300\n}\n"
         "GlobalSettings:  {\n Version: 1000\n Properties70:  {\n" +
         settings +
         " }\n}\nDefinitions:  {\n Version: 100\n Count: 2\n}\nObjects:  {\n"
         " Geometry: 10, \"Geometry::tri\", \"Mesh\" {\n  Vertices: *9 {\n   a: 0,0,0,100,0,0,0,0,200\n  }\n"
         "  PolygonVertexIndex: *3 {\n   a: 0,1,-3\n  }\n  GeometryVersion: 124\n }\n"
         " Model: 20, \"Model::limb\", \"Mesh\" {\n  Version: 232\n  Properties70:  {\n"
         "   P: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",1,2,3\n  }\n }\n}\n"
         "Connections:  {\n C: \"OO\",20,0\n C: \"OO\",10,20\n}\n";
}
std::string integer(const char* name, int value) {
  return fmt::format("  P: \"{}\", \"int\", \"Integer\", \"\",{}\n", name, value);
}
std::string axes(int up, int up_sign, int front, int front_sign, int right, int right_sign) {
  return integer("UpAxis", up) + integer("UpAxisSign", up_sign) + integer("FrontAxis", front) +
         integer("FrontAxisSign", front_sign) + integer("CoordAxis", right) +
         integer("CoordAxisSign", right_sign);
}

TEST(Assimp, FbxStatesItsUnitAndAxes) {
  const std::string unit = "  P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",2.54\n";
  const auto y_up = read(fbx(axes(1, 1, 2, 1, 0, 1) + unit), "a.fbx");
  ASSERT_TRUE(y_up) << y_up.error().message();
  EXPECT_NEAR(y_up->metres_per_unit.value(), 0.0254, 1e-9);
  EXPECT_LT(angle_between(y_up->yup_from_file.value(), Quat::Identity()), 1e-12);
  const int limb = y_up->skeleton.find("limb");
  ASSERT_GE(limb, 0);
  EXPECT_LT((y_up->skeleton.nodes[limb].rest.translation - Vec3(1, 2, 3)).norm(), 1e-6) << "file units";
  ASSERT_EQ(y_up->parts.size(), 1u);

  const auto z_up = read(fbx(axes(2, 1, 1, -1, 0, 1) + unit), "a.fbx");
  ASSERT_TRUE(z_up) << z_up.error().message();
  const Quat q = z_up->yup_from_file.value();
  EXPECT_LT((q * Vec3::UnitZ() - Vec3::UnitY()).norm(), 1e-12) << "up";
  EXPECT_LT((q * -Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-12) << "front";
  EXPECT_LT((q * Vec3::UnitX() - Vec3::UnitX()).norm(), 1e-12) << "right";

  const auto mirrored = read(fbx(axes(1, 1, 2, -1, 0, 1) + unit), "a.fbx");
  ASSERT_TRUE(mirrored) << mirrored.error().message();
  EXPECT_FALSE(mirrored->yup_from_file) << "left-handed";
}

TEST(Assimp, RefusesWhatItCannotRead) {
  for (const char* path : {"a.fbx", "a.dae"})
    for (const std::string& text :
         {std::string("nonsense"), std::string("\0\1\2\3", 4), std::string("<COLLADA>")}) {
      const auto c = read(text, path);
      ASSERT_FALSE(c) << path << text;
      EXPECT_EQ(c.error().kind, ErrorKind::input);
      EXPECT_EQ(c.error().file, path);
      EXPECT_EQ(c.error().what.substr(0, 15), "cannot be read:") << c.error().what;
    }
  EXPECT_EQ(read("x", "a.xyz").error().what, "extension '.xyz' is not known");
}

TEST(Assimp, OnlyTheImporterOfTheExtensionIsTried) {
  EXPECT_FALSE(read(dae(true), "figure.fbx")) << "a DAE by content";
  EXPECT_FALSE(read(fbx(""), "figure.dae")) << "an FBX by content";
}

TEST(Assimp, CutOffTextIsRefusedOrReadButNeverCrashes) {
  const std::string whole = dae(true);
  for (std::size_t length = 0; length < whole.size(); length += 97)
    (void)read(whole.substr(0, length), "a.dae");
  const std::string text = fbx(axes(1, 1, 2, 1, 0, 1));
  for (std::size_t length = 0; length < text.size(); length += 41)
    (void)read(text.substr(0, length), "a.fbx");
}

}  // namespace
}  // namespace ukemi
