// Skeletons made for the tests.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "base/character.h"

namespace ukemi::testing {

/// A human of 1.741 m in a T-pose facing +z, y up, metres: world-aligned nodes with Mixamo names.
struct FigureOptions {
  double arm_elevation_deg = 90.0;   // 90: T, 45: A, 0: hanging
  double unit = 1.0;                 // file units per metre
  Quat armature = Quat::Identity();  // rotation of an extra root
  double armature_scale = 1.0;       // the figure stays as large
  bool names = true;
  int spine_bones = 3;
  bool clavicles = true;
  bool hands = true;
  bool toes = true;
  bool twisted_nodes = false;  // every node with an arbitrary orientation of its own
};

class Builder {
 public:
  /// A node at a world place; returns its index.
  int add(const std::string& name, int parent, const Vec3& place) {
    character.skeleton.nodes.push_back({name, parent, {}});
    places_.push_back(place);
    return static_cast<int>(places_.size()) - 1;
  }

  Character finish(const FigureOptions& options) {
    std::vector<Affine> world(places_.size());
    for (std::size_t i = 0; i < places_.size(); ++i) {
      Node& node = character.skeleton.nodes[i];
      Quat q = options.armature;
      if (options.twisted_nodes)
        q = q *
            exp_rotation(Vec3(0.3 + 0.1 * static_cast<double>(i % 7), -0.5 + 0.2 * static_cast<double>(i % 5),
                              1.0 - 0.3 * static_cast<double>(i % 3)));
      Affine target = Affine::Identity();
      target.linear() = options.armature_scale * q.toRotationMatrix();
      target.translation() = options.armature * (options.unit * places_[i]);
      const Affine local = node.parent < 0 ? target : world[node.parent].inverse() * target;
      node.rest.translation = local.translation();
      node.rest.rotation = rotation_part(local.linear());
      node.rest.scale = Vec3::Constant(std::cbrt(local.linear().determinant()));
      world[i] = (node.parent < 0 ? Affine::Identity() : world[node.parent]) * node.rest.affine();
      if (!options.names) node.name.clear();
    }
    EXPECT_TRUE(character.skeleton.sort());
    character.path = "figure.glb";
    return character;
  }

  Character character;

 private:
  std::vector<Vec3> places_;
};

inline void add_arm(Builder& builder, const FigureOptions& o, int chest, double side,
                    const std::string& prefix) {
  const double a = radians(o.arm_elevation_deg);
  const Vec3 along(side * std::sin(a), -std::cos(a), 0.0);
  const Vec3 shoulder(side * 0.18, 1.42, 0.0);
  int node = chest;
  if (o.clavicles) node = builder.add(prefix + "Shoulder", node, Vec3(side * 0.05, 1.43, 0.02));
  node = builder.add(prefix + "Arm", node, shoulder);
  node = builder.add(prefix + "ForeArm", node, shoulder + 0.28 * along);
  if (!o.hands) return;
  node = builder.add(prefix + "Hand", node, shoulder + 0.54 * along);
  builder.add(prefix + "HandMiddle1", node, shoulder + 0.63 * along);
}

inline void add_leg(Builder& builder, const FigureOptions& o, int pelvis, double side,
                    const std::string& prefix) {
  int node = builder.add(prefix + "UpLeg", pelvis, Vec3(side * 0.09, 0.93, 0.0));
  node = builder.add(prefix + "Leg", node, Vec3(side * 0.09, 0.51, 0.005));
  node = builder.add(prefix + "Foot", node, Vec3(side * 0.09, 0.08, -0.01));
  if (o.toes) builder.add(prefix + "ToeBase", node, Vec3(side * 0.09, 0.015, 0.13));
}

inline Character figure(const FigureOptions& o = {}) {
  Builder builder;
  const int armature = builder.add("Armature", -1, Vec3::Zero());
  const int pelvis = builder.add("mixamorig:Hips", armature, Vec3(0, 1.0, 0));
  int chest = pelvis;
  for (int i = 0; i < o.spine_bones; ++i)
    chest = builder.add("mixamorig:Spine" + (i == 0 ? std::string() : std::to_string(i)), chest,
                        Vec3(0, 1.08 + 0.3 * i / o.spine_bones, -0.01));
  const int neck = builder.add("mixamorig:Neck", chest, Vec3(0, 1.48, 0.0));
  const int head = builder.add("mixamorig:Head", neck, Vec3(0, 1.56, 0.02));
  builder.add("mixamorig:HeadTop_End", head, Vec3(0, 1.741, 0.02));
  add_arm(builder, o, chest, 1.0, "mixamorig:Left");
  add_arm(builder, o, chest, -1.0, "mixamorig:Right");
  add_leg(builder, o, pelvis, 1.0, "mixamorig:Left");
  add_leg(builder, o, pelvis, -1.0, "mixamorig:Right");
  return builder.finish(o);
}

}  // namespace ukemi::testing
