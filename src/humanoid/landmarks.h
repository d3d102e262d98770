// Joint places of a pose and what kind of pose they make.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "base/character.h"
#include "humanoid/assemble.h"
#include "humanoid/humanoid.h"

namespace ukemi {

inline constexpr std::array<Segment, 2> kUpperArm = {Segment::upperarm_l, Segment::upperarm_r};
inline constexpr std::array<Segment, 2> kForearm = {Segment::forearm_l, Segment::forearm_r};
inline constexpr std::array<Segment, 2> kHand = {Segment::hand_l, Segment::hand_r};
inline constexpr std::array<Segment, 2> kThigh = {Segment::thigh_l, Segment::thigh_r};
inline constexpr std::array<Segment, 2> kShank = {Segment::shank_l, Segment::shank_r};
inline constexpr std::array<Segment, 2> kFoot = {Segment::foot_l, Segment::foot_r};

/// Angle between two directions, radians.
inline double angle(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Joint places of one pose, file units.
struct Landmarks {
  PerSegment<Vec3> origin;
  std::vector<Affine> world;

  Landmarks(const Character& character, const Humanoid& humanoid, const Pose& pose)
      : world(world_transforms(character.skeleton, pose)) {
    origin = origins_of(humanoid, world);
  }
  const Vec3& operator[](Segment s) const { return origin[index(s)]; }
  Vec3 hips() const { return (*this)[Segment::pelvis]; }
  Vec3 ankles() const { return 0.5 * ((*this)[Segment::foot_l] + (*this)[Segment::foot_r]); }
  Vec3 shoulders() const { return 0.5 * ((*this)[Segment::upperarm_l] + (*this)[Segment::upperarm_r]); }
  Vec3 rise() const { return (*this)[Segment::head] - ankles(); }
  Vec3 link(Segment upper, Segment lower) const { return (*this)[lower] - (*this)[upper]; }
};

/// World axis (signed) along which a vector is longest.
Vec3 dominant_axis(const Vec3& v);

/// A trunk that rises from the legs, with hips and shoulders across it; limbs may be anywhere.
bool humanlike(const Landmarks& f);
/// A pose from which frames can be read, whatever its orientation: humanlike, no limb folded, arms not
/// overhead.
bool usable(const Landmarks& f);
/// Largest tilt of a thigh or shank from the vertical, radians.
double leg_tilt(const Landmarks& f, const Vec3& up);
/// Tilts of trunk, thighs, shanks and half those of the arms, radians: 0 for the neutral pose.
double neutrality(const Landmarks& f, const Vec3& up);
RestPoseClass class_of(const Landmarks& f, const Vec3& up);
/// A frame that a capture system put there on purpose: upright, legs straight down, arms straight to the
/// sides.
bool exact_t_pose(const Landmarks& f, const Vec3& up);

}  // namespace ukemi
