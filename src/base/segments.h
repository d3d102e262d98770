// The 18 segments and 17 joints of the body (Era et al., section 5: "a 17-jointed articulated body").
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace ukemi {

/// Parents before children. Every segment but the pelvis hangs on exactly one joint.
enum class Segment : int {
  pelvis,
  abdomen,
  chest,
  head,
  clavicle_l,
  upperarm_l,
  forearm_l,
  hand_l,
  clavicle_r,
  upperarm_r,
  forearm_r,
  hand_r,
  thigh_l,
  shank_l,
  foot_l,
  thigh_r,
  shank_r,
  foot_r,
};
inline constexpr int kSegmentCount = 18;

/// Joint j is the one above segment j + 1.
enum class Joint : int {
  spine,
  chest,
  neck,
  clavicle_l,
  shoulder_l,
  elbow_l,
  wrist_l,
  clavicle_r,
  shoulder_r,
  elbow_r,
  wrist_r,
  hip_l,
  knee_l,
  ankle_l,
  hip_r,
  knee_r,
  ankle_r,
};
inline constexpr int kJointCount = 17;

constexpr int index(Segment s) { return static_cast<int>(s); }
constexpr int index(Joint j) { return static_cast<int>(j); }
constexpr Segment segment_at(int i) { return static_cast<Segment>(i); }
constexpr Joint joint_at(int i) { return static_cast<Joint>(i); }

/// The segment below a joint, and the joint above a segment (not the pelvis).
constexpr Segment child_of(Joint j) { return segment_at(index(j) + 1); }
constexpr Joint joint_above(Segment s) { return joint_at(index(s) - 1); }
/// The segment above; the pelvis is its own parent.
Segment parent_of(Segment s);
inline Segment parent_of(Joint j) { return parent_of(child_of(j)); }
/// Left for right and right for left; middle segments and joints are their own mirror.
Segment mirror_of(Segment s);
Joint mirror_of(Joint j);
constexpr bool is_left(Joint j) {
  return (j >= Joint::clavicle_l && j <= Joint::wrist_l) || (j >= Joint::hip_l && j <= Joint::ankle_l);
}
constexpr bool is_right(Joint j) {
  return (j >= Joint::clavicle_r && j <= Joint::wrist_r) || (j >= Joint::hip_r && j <= Joint::ankle_r);
}

std::string_view name(Segment s);
std::string_view name(Joint j);
/// By its name, or as artists, Unity, Unreal and VRM say: hips, torso, "left upper leg", calf_l, LowerArm.R.
std::optional<Segment> segment_named(std::string_view text);
std::optional<Joint> joint_named(std::string_view text);

template <typename T>
using PerSegment = std::array<T, kSegmentCount>;
template <typename T>
using PerJoint = std::array<T, kJointCount>;

}  // namespace ukemi
