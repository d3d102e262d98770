// Segments of a pose, as the rig has them and with the free rolls of a human body.
#include <algorithm>
#include <cmath>

#include "humanoid/assemble.h"
#include "humanoid/humanoid.h"

namespace ukemi {
namespace {

Quat about_y(double angle) { return Quat(std::cos(0.5 * angle), 0.0, std::sin(0.5 * angle), 0.0); }

/// q = exp(swing) * twist about y, with the swing's rotation vector perpendicular to y.
struct SwingAboutY {
  Vec3 swing;
  double twist;
};

SwingAboutY split_about_y(const Quat& q) {
  const double twist = twist_angle(q, Vec3::UnitY());
  return {log_rotation(q * about_y(-twist)), twist};
}

/// (b): the abdomen takes 0.46, 0.54, 0.30 of side bend, flexion and turn between pelvis
/// and chest, the ratio of the two joints' ranges.
void split_trunk(BodyPose& body) {
  const Quat& pelvis = body[index(Segment::pelvis)].rotation;
  const SwingAboutY total = split_about_y(pelvis.conjugate() * body[index(Segment::chest)].rotation);
  const Vec3 swing(0.46 * total.swing.x(), 0.0, 0.54 * total.swing.z());  // about x: side bend; z: flexion
  body[index(Segment::abdomen)].rotation = pelvis * exp_rotation(swing) * about_y(0.30 * total.twist);
}

/// (a): the wrist does not twist, the forearm does.
void give_twist_to_forearm(BodyPose& body, Segment forearm, Segment hand) {
  Quat& rotation = body[index(forearm)].rotation;
  const Quat relative = rotation.conjugate() * body[index(hand)].rotation;
  rotation = rotation * about_y(twist_angle(relative, Vec3::UnitY()));
}

double smoothstep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// (c): rolls the upper segment about its axis until the lower one bends in its x-y plane, towards +x (elbow)
/// or -x (knee). A bend to the side is a roll of the rig, one to the back is hyperextension and stays.
void roll_into_hinge_plane(BodyPose& body, Segment upper, Segment lower, double flexion_side) {
  Quat& rotation = body[index(upper)].rotation;
  const Vec3 link = rotation.conjugate() * (body[index(lower)].rotation * -Vec3::UnitY());
  const double bend = std::atan2(std::hypot(link.x(), link.z()), -link.y());
  const double roll = std::atan2(-flexion_side * link.z(), flexion_side * link.x());
  const double most = radians(90.0) + radians(30.0) * smoothstep(radians(14), radians(30), bend);
  if (std::abs(roll) > most) return;
  rotation = rotation * about_y(smoothstep(radians(4), radians(14), bend) * roll);
}

/// (d): 60 % of the foot's toe-out about the shank axis is rotation of the tibia, 18 in to 24 degrees out.
void give_toe_out_to_shank(BodyPose& body, Segment shank, Segment foot, double outwards) {
  Quat& rotation = body[index(shank)].rotation;
  const double turn = twist_angle(rotation.conjugate() * body[index(foot)].rotation, Vec3::UnitY());
  const double share = std::clamp(0.6 * outwards * turn, radians(-18), radians(24));
  rotation = rotation * about_y(outwards * share);
}

}  // namespace

BodyPose segments_of(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& pose) {
  const std::vector<Affine> world = world_transforms(skeleton, pose);
  const PerSegment<Vec3> origins = origins_of(humanoid, world);
  const Quat& upright = humanoid.world_from_file.rotation;
  BodyPose body;
  for (int s = 0; s < kSegmentCount; ++s) {
    const Quat node = rotation_part(world[humanoid.carrier_node(segment_at(s))].linear());
    body[s].rotation = (upright * node * humanoid.node_from_segment[s]).normalized();
    body[s].translation = humanoid.world_from_file * origins[s];
  }
  return body;
}

BodyPose canonical_segments_of(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& pose) {
  BodyPose body = segments_of(skeleton, humanoid, pose);
  const auto movable = [&](Segment s) { return !humanoid.segments[index(s)].fused(); };
  if (movable(Segment::abdomen) && movable(Segment::chest)) split_trunk(body);
  for (const bool left : {true, false}) {
    const auto side = [&](Segment s) { return left ? s : mirror_of(s); };
    if (movable(side(Segment::hand_l)))
      give_twist_to_forearm(body, side(Segment::forearm_l), side(Segment::hand_l));
    roll_into_hinge_plane(body, side(Segment::upperarm_l), side(Segment::forearm_l), 1.0);
    roll_into_hinge_plane(body, side(Segment::thigh_l), side(Segment::shank_l), -1.0);
    if (movable(side(Segment::foot_l)))
      give_toe_out_to_shank(body, side(Segment::shank_l), side(Segment::foot_l), left ? 1.0 : -1.0);
  }
  const auto carry_fused = [&](Segment s) {
    if (movable(s)) return;
    const int c = index(humanoid.carrier(s));
    const Quat relative = humanoid.node_from_segment[c].conjugate() * humanoid.node_from_segment[index(s)];
    body[index(s)].rotation = (body[c].rotation * relative).normalized();
  };
  for (int s = 0; s < kSegmentCount; ++s) carry_fused(segment_at(s));
  return body;
}

}  // namespace ukemi
