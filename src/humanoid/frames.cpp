#include "humanoid/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "humanoid/assemble.h"
#include "humanoid/bones.h"
#include "humanoid/skin.h"

namespace ukemi {
namespace {

constexpr std::array<Segment, 2> kUpperArm = {Segment::upperarm_l, Segment::upperarm_r};
constexpr std::array<Segment, 2> kForearm = {Segment::forearm_l, Segment::forearm_r};
constexpr std::array<Segment, 2> kHand = {Segment::hand_l, Segment::hand_r};
constexpr std::array<Segment, 2> kThigh = {Segment::thigh_l, Segment::thigh_r};
constexpr std::array<Segment, 2> kShank = {Segment::shank_l, Segment::shank_r};
constexpr std::array<Segment, 2> kFoot = {Segment::foot_l, Segment::foot_r};

/// Angle between two directions, radians.
double angle(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Joint places of one pose, file units.
struct Figure {
  PerSegment<Vec3> origin;
  std::vector<Affine> world;

  Figure(const Character& character, const Humanoid& humanoid, const Pose& pose)
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

/// World axis (signed) along which the head lies farthest from the feet.
Vec3 dominant_axis(const Vec3& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return (v[axis] < 0.0 ? -1.0 : 1.0) * Vec3::Unit(axis);
}

/// A pose from which frames can be read, whatever its orientation: legs away from the trunk, hips and
/// shoulders across it, knees and elbows not folded.
bool usable(const Figure& f) {
  const Vec3 trunk = f.shoulders() - f.hips();
  const Vec3 across_hips = f.link(Segment::thigh_l, Segment::thigh_r);
  const Vec3 across_shoulders = f.link(Segment::upperarm_l, Segment::upperarm_r);
  if (angle(across_hips, across_shoulders) > radians(35)) return false;
  if (std::abs(angle(trunk, across_hips) - radians(90)) > radians(35)) return false;
  for (int side = 0; side < 2; ++side) {
    const Vec3 leg = f.link(kThigh[side], kFoot[side]);
    if (angle(leg, -trunk) > radians(50)) return false;
    if (angle(f.link(kThigh[side], kShank[side]), f.link(kShank[side], kFoot[side])) > radians(100))
      return false;
    if (angle(f.link(kUpperArm[side], kForearm[side]), f.link(kForearm[side], kHand[side])) > radians(100))
      return false;
    if (angle(f.link(kUpperArm[side], kForearm[side]), -trunk) > radians(135)) return false;
  }
  return true;
}

double leg_tilt(const Figure& f, const Vec3& up) {
  double worst = 0.0;
  for (int side = 0; side < 2; ++side)
    for (const Vec3& link : {f.link(kThigh[side], kShank[side]), f.link(kShank[side], kFoot[side])})
      worst = std::max(worst, angle(link, -up));
  return worst;
}

/// Tilts of trunk, thighs, shanks and half those of the arms, radians: 0 for the neutral pose.
double neutrality(const Figure& f, const Vec3& up) {
  double sum = angle(f.shoulders() - f.hips(), up);
  for (int side = 0; side < 2; ++side) {
    sum += angle(f.link(kThigh[side], kShank[side]), -up) + angle(f.link(kShank[side], kFoot[side]), -up);
    sum += 0.5 * angle(f.link(kUpperArm[side], kForearm[side]), -up);
    sum += 0.5 * angle(f.link(kForearm[side], kHand[side]), -up);
  }
  return sum;
}

RestPoseClass class_of(const Figure& f, const Vec3& up) {
  double lowest = kPi, highest = 0.0;
  for (int side = 0; side < 2; ++side) {
    const double arm = angle(f.link(kUpperArm[side], kForearm[side]), -up);
    lowest = std::min(lowest, arm);
    highest = std::max(highest, arm);
    if (angle(f.link(kUpperArm[side], kForearm[side]), f.link(kForearm[side], kHand[side])) > radians(45))
      return RestPoseClass::other;
  }
  if (leg_tilt(f, up) > radians(30) || angle(f.shoulders() - f.hips(), up) > radians(25))
    return RestPoseClass::other;
  if (lowest > radians(72) && highest < radians(108)) return RestPoseClass::t_pose;
  if (highest < radians(20)) return RestPoseClass::neutral;
  if (lowest > radians(20) && highest <= radians(80)) return RestPoseClass::a_pose;
  return highest < radians(30) ? RestPoseClass::neutral : RestPoseClass::other;
}

/// A frame that a capture system put there on purpose: upright, legs straight down, arms straight to the
/// sides.
bool exact_t_pose(const Figure& f, const Vec3& up) {
  if (leg_tilt(f, up) > radians(8)) return false;
  const Vec3 across = f.link(Segment::thigh_l, Segment::thigh_r);
  for (int side = 0; side < 2; ++side) {
    const Vec3 outwards = side == 0 ? Vec3(-across) : across;
    const Vec3 upper = f.link(kUpperArm[side], kForearm[side]), lower = f.link(kForearm[side], kHand[side]);
    if (std::abs(angle(upper, up) - radians(90)) > radians(6) || angle(upper, lower) > radians(6))
      return false;
    if (angle(upper, outwards) > radians(25)) return false;
  }
  return angle(f.shoulders() - f.hips(), up) < radians(12);
}

// --- reference pose
// ------------------------------------------------------------------------------------------

std::vector<double> sample_times(const Animation& animation, int at_most) {
  const double fps = animation.fps > 0.0 ? animation.fps : 30.0;
  const int frames = std::max(1, static_cast<int>(std::lround(animation.duration_s() * fps)) + 1);
  const int stride = (frames + at_most - 1) / at_most;
  std::vector<double> times;
  for (int i = 0; i < frames; i += stride) times.push_back(animation.start_s + i / fps);
  return times;
}

/// The up axis of a motion, from the mean of where the head is above the feet.
Vec3 up_of_motion(const Character& character, const Humanoid& humanoid) {
  Vec3 sum = Vec3::Zero();
  for (const double t : sample_times(character.animations[0], 100))
    sum += Figure(character, humanoid, sample(character.skeleton, character.animations[0], t))
               .rise()
               .normalized();
  return dominant_axis(sum);
}

Pose turned(const Character& character, Pose pose, const Quat& rotation) {
  for (int i = 0; i < character.skeleton.size(); ++i)
    if (character.skeleton.nodes[i].parent < 0) {
      pose[i].rotation = rotation * pose[i].rotation;
      pose[i].translation = rotation * pose[i].translation;
    }
  return pose;
}

/// First exact T-pose of the motion, else the frame nearest to the neutral pose.
Pose best_frame(const Character& character, const Humanoid& humanoid, const Vec3& up) {
  Pose best = rest_pose(character.skeleton);
  double best_tilt = 1e300;
  for (const double t : sample_times(character.animations[0], 4000)) {
    Pose pose = sample(character.skeleton, character.animations[0], t);
    const Figure figure(character, humanoid, pose);
    if (exact_t_pose(figure, up)) return pose;
    if (const double tilt = neutrality(figure, up); tilt < best_tilt) {
      best_tilt = tilt;
      best = std::move(pose);
    }
  }
  return best;
}

/// The pose in which the skin was bound, where inverse-bind matrices give it: joints whose parent is in the
/// same skin, all others as at rest.
Pose bind_pose(const Character& character) {
  const Skeleton& skeleton = character.skeleton;
  Pose pose = rest_pose(skeleton);
  std::vector<char> done(pose.size(), 0);
  for (const Skin& skin : character.skins) {
    std::vector<int> place(pose.size(), -1);
    for (std::size_t j = 0; j < skin.joints.size() && j < skin.inverse_bind.size(); ++j)
      place[skin.joints[j]] = static_cast<int>(j);
    for (const int node : skin.joints) {
      const int parent = skeleton.nodes[node].parent;
      if (done[node] || parent < 0 || place[node] < 0 || place[parent] < 0) continue;
      const Affine& node_from_mesh = skin.inverse_bind[place[node]];
      if (std::abs(node_from_mesh.linear().determinant()) < 1e-30) continue;
      const Affine local = skin.inverse_bind[place[parent]] * node_from_mesh.inverse();
      pose[node].rotation = rotation_part(local.linear());
      pose[node].translation = local.translation();
      done[node] = 1;
    }
  }
  return pose;
}

struct Reference {
  Pose pose;
  Vec3 up;  // file axes
};

/// Turned upright where the figure leans against every axis of the file (an armature with a rotation of its
/// own).
Reference upright(const Character& character, const Humanoid& humanoid, Pose pose, const Vec3& up) {
  const Vec3 rise = Figure(character, humanoid, pose).rise();
  if (angle(rise, up) < radians(25)) return {std::move(pose), up};
  const Vec3 stands = character.format == SourceFormat::gltf ? Vec3(Vec3::UnitY()) : up;
  return {turned(character, std::move(pose), shortest_rotation(rise, stands)), stands};
}

/// A rest pose is as good as the neutral pose when the legs are straight and the arms straight.
bool clean(const Figure& figure, const Vec3& up) {
  return usable(figure) && class_of(figure, up) != RestPoseClass::other && leg_tilt(figure, up) < radians(15);
}

Reference reference_of_motion_file(const Character& character, const Humanoid& humanoid) {
  const Pose rest = rest_pose(character.skeleton);
  const Figure figure(character, humanoid, rest);
  const Vec3 rest_up = dominant_axis(figure.rise());
  const Vec3 up = up_of_motion(character, humanoid);
  if (!usable(figure)) return {best_frame(character, humanoid, up), up};
  if (leg_tilt(figure, rest_up) > radians(12)) {
    const Pose first = sample(character.skeleton, character.animations[0], character.animations[0].start_s);
    if (exact_t_pose(Figure(character, humanoid, first), up)) return {first, up};
  }
  return {up == rest_up ? rest : turned(character, rest, shortest_rotation(rest_up, up)), up};
}

/// ANATOMICAL_FRAMES 2.2 items 1 and 2: the zero pose or a frame of a motion file; of a character the rest
/// pose, the bind pose where that is cleaner, else the best frame of its first animation.
Reference find_reference(const Character& character, const Humanoid& humanoid) {
  const bool has_motion = !character.animations.empty() && !character.animations[0].tracks.empty();
  if (character.format == SourceFormat::bvh && has_motion)
    return reference_of_motion_file(character, humanoid);
  const Pose rest = rest_pose(character.skeleton);
  const Figure figure(character, humanoid, rest);
  const Vec3 up = dominant_axis(figure.rise());
  if (!clean(figure, up)) {
    const Pose bind = bind_pose(character);
    const Figure bound(character, humanoid, bind);
    const Vec3 bind_up = dominant_axis(bound.rise());
    const bool better = usable(bound) && class_of(bound, bind_up) != RestPoseClass::other &&
                        leg_tilt(bound, bind_up) < leg_tilt(figure, up);
    if (better) return {bind, bind_up};
  }
  if (usable(figure)) return upright(character, humanoid, rest, up);
  if (!has_motion) return {rest, up};
  const Vec3 motion_up = up_of_motion(character, humanoid);
  return {best_frame(character, humanoid, motion_up), motion_up};
}

// --- size
// ----------------------------------------------------------------------------------------------------

/// Sole to crown, file units. From the skin where its extent fits the skeleton, else from the bones: the
/// ankles stand 0.045, the head joint 0.86 of the height above the floor (typical rigs, de Leva 1996 for the
/// ankle).
double height_in_file(const Character& character, const Humanoid& humanoid, const Reference& reference) {
  const Figure f(character, humanoid, reference.pose);
  double legs = 0.0;
  for (int side = 0; side < 2; ++side)
    legs += 0.5 * (f.link(kThigh[side], kShank[side]).norm() + f.link(kShank[side], kFoot[side]).norm());
  const Vec3 neck = f.world[humanoid.segments[index(Segment::head)].chain.front()].translation();
  const Vec3 head = f.world[humanoid.segments[index(Segment::head)].node()].translation();
  const double body = legs + (neck - f.hips()).norm() + (head - neck).norm();
  double height = body / 0.815;
  if (humanoid.head_top >= 0) {
    const double top = (f.world[humanoid.head_top].translation() - head).norm();
    if (top > 0.05 * body && top < 0.6 * body) height = (body + top) / 0.955;
  }
  const SkinExtent extent = skin_extent(character, f.world, reference.up);
  const double skin_height = extent.max - extent.min;
  if (extent.found && skin_height > 0.85 * height && skin_height < 1.6 * height) return skin_height;
  return height;
}

struct Unit {
  double metres;
  std::string warning;
};

/// The unit that makes the figure a human of 1.7 m.
Unit guess_unit(const Character& character, double height) {
  constexpr double kCmu = 0.056444;  // cgspeed conversions of the CMU data: 1/0.45 inches
  if (character.format == SourceFormat::gltf && height >= 0.3 && height <= 30.0) return {1.0, {}};
  double best = 0.0, best_error = 1e300;
  for (const double unit : {1.0, 0.01, 0.0254, 0.001, 0.1, kCmu}) {
    const double metres = unit * height;
    const double error = std::abs(std::log(metres / 1.7));
    if (metres >= 0.8 && metres <= 2.4 && error < best_error) {
      best = unit;
      best_error = error;
    }
  }
  if (best > 0.0) return {best, {}};
  return {1.741 / height,
          fmt::format("no usual unit makes the character human-sized ({} file units tall); its height "
                      "is taken as 1.741 m: --height or --unit sets it",
                      height)};
}

Unit choose_unit(const Character& character, const HumanoidOptions& options, double height) {
  if (options.height_m) return {*options.height_m / height, {}};
  if (options.metres_per_unit) return {*options.metres_per_unit, {}};
  if (character.metres_per_unit) {
    const double metres = *character.metres_per_unit * height;
    if (metres >= 0.3 && metres <= 30.0) return {*character.metres_per_unit, {}};
    Unit unit = guess_unit(character, height);
    unit.warning = fmt::format(
        "the file's unit ({} m) would make the character {:.3g} m tall; one unit is taken as "
        "{:.4g} m: --unit or --height sets it",
        *character.metres_per_unit, metres, unit.metres);
    return unit;
  }
  return guess_unit(character, height);
}

Vec3 choose_up(const Character& character, const HumanoidOptions& options, const Vec3& guess,
               Diagnostics& diagnostics) {
  if (options.up_axis) return Vec3::Unit(*options.up_axis - 'x');
  if (character.yup_from_file) {
    const Vec3 stated = character.yup_from_file->conjugate() * Vec3::UnitY();
    if (stated.dot(guess) > 0.9) return stated;
    diagnostics.warn(character.path.string(),
                     "the character does not stand along the file's up axis; up is taken from "
                     "its feet to its head: --up sets it");
  }
  return guess;
}

// --- frames
// --------------------------------------------------------------------------------------------------

/// Frame with the given y axis and the z axis nearest to `z`; columns x y z.
Mat3 frame_yz(const Vec3& y_hint, const Vec3& z_hint) {
  const Vec3 y = y_hint.normalized();
  Vec3 z = z_hint - z_hint.dot(y) * y;
  if (z.norm() < 1e-6 * z_hint.norm()) z = y.unitOrthogonal();
  z.normalize();
  Mat3 m;
  m << y.cross(z), y, z;
  return m;
}
Mat3 frame_yx(const Vec3& y_hint, const Vec3& x_hint) {
  const Vec3 y = y_hint.normalized();
  Vec3 x = x_hint - x_hint.dot(y) * y;
  if (x.norm() < 1e-6 * x_hint.norm()) x = y.unitOrthogonal();
  x.normalize();
  Mat3 m;
  m << x, y, x.cross(y);
  return m;
}

struct FrameBuilder {
  const Character& character;
  const Humanoid& humanoid;
  const Figure figure;
  Vec3 up;
  Mat3 w;  // anterior, up, right
  PerSegment<Mat3> frame;

  FrameBuilder(const Character& c, const Humanoid& h, const Reference& reference)
      : character(c), humanoid(h), figure(c, h, reference.pose), up(reference.up) {
    Vec3 right = figure.link(Segment::thigh_l, Segment::thigh_r);
    right = (right - right.dot(up) * up).normalized();
    w << up.cross(right), up, right;
    frame.fill(w);
  }

  Vec3 anterior() const { return w.col(0); }
  Vec3 place(int node) const { return figure.world[node].translation(); }

  /// Item 2: how far the toes lie in front of the ankles; 0 where there are none.
  double toes_forward() const {
    double sum = 0.0;
    for (int side = 0; side < 2; ++side) {
      const auto toe = toe_place(side);
      if (toe) sum += (*toe - figure[kFoot[side]]).dot(anterior());
    }
    return sum;
  }

  /// The same from the skin around the foot bones: how much farther it reaches forwards than backwards.
  double skin_forward() const {
    double sum = 0.0;
    for (int side = 0; side < 2; ++side) {
      const int foot = humanoid.segments[index(kFoot[side])].node();
      if (foot < 0) continue;
      const SkinExtent extent = skin_extent(character, figure.world, anterior(), [&](int node) {
        return is_at_or_below(character.skeleton, foot, node);
      });
      const double ankle = figure[kFoot[side]].dot(anterior());
      if (extent.found) sum += extent.max + extent.min - 2.0 * ankle;
    }
    return sum;
  }

  std::optional<Vec3> toe_place(int side) const {
    if (humanoid.toes[side] >= 0) return place(humanoid.toes[side]);
    const int node = humanoid.segments[index(kFoot[side])].node();
    if (node >= 0 && character.bvh && character.bvh->end_site[node])
      return figure.world[node] * *character.bvh->end_site[node];
    return std::nullopt;
  }

  /// Items 3 to 8.
  void build(double clavicle_elevation) {
    for (int side = 0; side < 2; ++side) {
      const Segment clavicle = side == 0 ? Segment::clavicle_l : Segment::clavicle_r;
      const double raised = side == 0 ? clavicle_elevation : -clavicle_elevation;  // about anterior
      if (!humanoid.segments[index(clavicle)].fused())
        frame[index(clavicle)] = w * exp_rotation(Vec3(raised, 0, 0)).toRotationMatrix();
      arm(side);
      leg(side);
    }
  }

  void arm(int side) {
    const Vec3 upper = figure.link(kUpperArm[side], kForearm[side]);
    const Vec3 lower = figure.link(kForearm[side], kHand[side]);
    const Quat lowered = shortest_rotation(upper, -up);
    const Mat3 upper_frame = lowered.conjugate().toRotationMatrix() * w;
    frame[index(kUpperArm[side])] = upper_frame;
    const int hand = humanoid.carrier_node(kHand[side]);
    const int index_finger = find_below(character.skeleton, hand, "index");
    int last_finger = find_below(character.skeleton, hand, "pinky");
    if (last_finger < 0) last_finger = find_below(character.skeleton, hand, "little");
    Vec3 thumb_side = shortest_rotation(upper, lower) * Vec3(upper_frame.col(0));
    if (index_finger >= 0 && last_finger >= 0) {
      const Vec3 across = place(index_finger) - place(last_finger);
      if (across.norm() > 0.05 * lower.norm()) thumb_side = across;
    }
    frame[index(kForearm[side])] = frame_yx(-lower, thumb_side);
    const int middle = humanoid.middle_finger[side];
    const Vec3 palm = middle >= 0 ? Vec3(place(middle) - figure[kHand[side]]) : lower;
    const bool points_on = palm.norm() > 0.05 * lower.norm() && angle(palm, lower) < radians(60);
    frame[index(kHand[side])] = frame_yx(points_on ? Vec3(-palm) : Vec3(-lower), thumb_side);
  }

  void leg(int side) {
    const Vec3 thigh = figure.link(kThigh[side], kShank[side]),
               shank = figure.link(kShank[side], kFoot[side]);
    const Mat3 thigh_frame = shortest_rotation(thigh, -up).conjugate().toRotationMatrix() * w;
    frame[index(kThigh[side])] = thigh_frame;
    frame[index(kShank[side])] = frame_yz(-shank, thigh_frame.col(2));
    // Item 8: y up once the shank is vertical. A bent knee (or a foot on a bone of its own) means a flat foot
    // already.
    const bool spread = angle(thigh, shank) < radians(20) && !humanoid.segments[index(kFoot[side])].detached;
    const Quat upright =
        spread && angle(shank, -up) > radians(8) ? shortest_rotation(shank, -up) : Quat::Identity();
    Vec3 forward = anterior();
    if (const auto toe = toe_place(side)) {
      const Vec3 to_toe = upright * Vec3(*toe - figure[kFoot[side]]);
      const Vec3 horizontal = to_toe - to_toe.dot(up) * up;
      if (horizontal.norm() > 0.3 * to_toe.norm() && horizontal.norm() > 0.0) forward = horizontal;
    }
    frame[index(kFoot[side])] = upright.conjugate().toRotationMatrix() * frame_yx(up, forward);
  }
};

/// How far raised arms hold the shoulders up (ANATOMICAL_FRAMES 2.3; an A-pose as RANGE_OF_MOTION has it),
/// radians.
double clavicle_elevation(RestPoseClass pose) {
  if (pose == RestPoseClass::t_pose) return radians(8);
  return pose == RestPoseClass::a_pose ? radians(3) : 0.0;
}

RestPoseClass class_of_rest(const Character& character, const Humanoid& humanoid) {
  const Figure rest(character, humanoid, rest_pose(character.skeleton));
  return usable(rest) ? class_of(rest, dominant_axis(rest.rise())) : RestPoseClass::other;
}

}  // namespace

Status find_frames(const Character& character, const HumanoidOptions& options, Humanoid& humanoid,
                   Diagnostics& diagnostics) {
  Reference reference = find_reference(character, humanoid);
  if (!usable(Figure(character, humanoid, reference.pose)))
    return input_error(
        character,
        "not a humanoid: bones were found by name, but no pose of the file has a trunk that rises from "
        "two legs with an arm on each side",
        "if the character is a human, check the bones with --map SEGMENT=NODE");
  const FrameBuilder first(character, humanoid, reference);
  const double forward = first.toes_forward();
  if (forward < 0.0 || (forward == 0.0 && first.skin_forward() < 0.0)) {
    swap_sides(humanoid);
    diagnostics.warn(character.path.string(),
                     "left and right are exchanged: the feet point the other way than the names say");
  }
  reference.up = choose_up(character, options, reference.up, diagnostics);
  humanoid.rest_pose = class_of_rest(character, humanoid);
  FrameBuilder builder(character, humanoid, reference);
  builder.build(clavicle_elevation(class_of(builder.figure, reference.up)));
  for (int s = 0; s < kSegmentCount; ++s) {
    const Quat node = rotation_part(builder.figure.world[humanoid.carrier_node(segment_at(s))].linear());
    humanoid.node_from_segment[s] = (node.conjugate() * Quat(builder.frame[s])).normalized();
  }
  const double height = height_in_file(character, humanoid, reference);
  const Unit unit = choose_unit(character, options, height);
  if (!unit.warning.empty()) diagnostics.warn(character.path.string(), unit.warning);
  humanoid.height_m = height * unit.metres;
  humanoid.world_from_file = {unit.metres, shortest_rotation(reference.up, Vec3::UnitY()), Vec3::Zero()};
  int axis = 0;
  reference.up.cwiseAbs().maxCoeff(&axis);
  humanoid.up_axis = static_cast<char>('x' + axis);
  humanoid.reference = std::move(reference.pose);
  return Done{};
}

}  // namespace ukemi
