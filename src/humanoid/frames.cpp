#include "humanoid/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "humanoid/assemble.h"
#include "humanoid/bones.h"
#include "humanoid/landmarks.h"
#include "humanoid/reference.h"
#include "humanoid/refine.h"
#include "humanoid/skin.h"

namespace ukemi {
namespace {

// --- size
// ----------------------------------------------------------------------------------------------------

/// Distance from the head joint to the node or BVH end site that marks the crown; 0 where there is none.
double head_length(const Character& character, const Humanoid& humanoid, const Landmarks& f) {
  const int head = humanoid.segments[index(Segment::head)].node();
  const Vec3 joint = f.world[head].translation();
  if (humanoid.head_top >= 0) return (f.world[humanoid.head_top].translation() - joint).norm();
  if (character.bvh && character.bvh->end_site[head])
    return (f.world[head] * *character.bvh->end_site[head] - joint).norm();
  return 0.0;
}

/// Sole to crown, file units. From the skin where its extent fits the skeleton, else from the bones: hip to
/// ankle is 0.491 of the height (de Leva 1996), ankle to head joint 0.84 to 0.91 of it over the rigs that
/// were looked at.
double height_in_file(const Character& character, const Humanoid& humanoid, const Reference& reference) {
  const Landmarks f(character, humanoid, reference.pose);
  double legs = 0.0;
  for (int side = 0; side < 2; ++side)
    legs += 0.5 * (f.link(kThigh[side], kShank[side]).norm() + f.link(kShank[side], kFoot[side]).norm());
  const Vec3 neck = f.world[humanoid.segments[index(Segment::head)].chain.front()].translation();
  const Vec3 head = f.world[humanoid.segments[index(Segment::head)].node()].translation();
  const double body = legs + (neck - f.hips()).norm() + (head - neck).norm();
  double height = 0.65 * body / 0.8625 + 0.35 * legs / 0.491;
  const double top = head_length(character, humanoid, f);
  if (top > 0.05 * body && top < 0.6 * body) height = std::max(height, (body + top) / 0.955);
  // Ears, hair and hats that have bones of their own do not count.
  const int head_node = humanoid.segments[index(Segment::head)].node();
  const std::vector<char> skinned = skin_joints(character);
  const SkinExtent extent = skin_extent(character, f.world, reference.up, [&](int node) {
    return !skinned[node] || !character.skeleton.is_ancestor(head_node, node);
  });
  const double skin_height = extent.max - extent.min;
  if (extent.found && skin_height > 0.85 * height && skin_height < 2.1 * height) return skin_height;
  return height;
}

struct Unit {
  double metres;
  std::string warning;
};

// A stated unit is believed for a child and for a tall cartoon; asset packs of any other size mean humans,
// and a blow of human strength would do nothing to a body of two tonnes.
constexpr double kShortest = 0.3;  // m
constexpr double kTallest = 3.0;   // m

/// The unit that makes the figure a human of 1.7 m.
Unit guess_unit(const Character& character, double height) {
  constexpr double kCmu = 0.056444;  // cgspeed conversions of the CMU data: 1/0.45 inches
  if (character.format == SourceFormat::gltf && height >= kShortest && height <= kTallest) return {1.0, {}};
  double best = 0.0, best_error = 1e300;
  for (const double unit : {1.0, 0.01, 0.0254, 0.001, 0.1, kCmu, 0.01 * kCmu}) {
    const double metres = unit * height;
    const double error = std::abs(std::log(metres / 1.7));
    if (metres >= 1.2 && metres <= 2.4 && error < best_error) {
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
    if (metres >= kShortest && metres <= kTallest) return {*character.metres_per_unit, {}};
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

/// The part of `hint` that is perpendicular to the unit vector `y`, as a unit vector; any where there is
/// none.
Vec3 perpendicular(const Vec3& y, const Vec3& hint) {
  const Vec3 part = hint - hint.dot(y) * y;
  return part.norm() < 1e-6 * hint.norm() ? y.unitOrthogonal() : part.normalized();
}

/// Frame with the given y axis and the z axis nearest to `z_hint`; columns x y z.
Mat3 frame_yz(const Vec3& y_hint, const Vec3& z_hint) {
  const Vec3 y = y_hint.normalized(), z = perpendicular(y, z_hint);
  Mat3 m;
  m << y.cross(z), y, z;
  return m;
}

/// Frame with the given y axis and the x axis nearest to `x_hint`.
Mat3 frame_yx(const Vec3& y_hint, const Vec3& x_hint) {
  const Vec3 y = y_hint.normalized(), x = perpendicular(y, x_hint);
  Mat3 m;
  m << x, y, x.cross(y);
  return m;
}

struct FrameBuilder {
  const Character& character;
  const Humanoid& humanoid;
  const Landmarks figure;
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

  /// Rule 2: how far the toes lie in front of the ankles; 0 where there are none.
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

  /// Rules 3 to 8.
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
    // Rule 8. Below a bent knee, or on a bone of its own, the foot lies flat already.
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

/// How far raised arms hold the shoulders up against the hanging arm (an assumption: mocap of one suit showed
/// 14 to 25 degrees for a T-pose), radians.
double clavicle_elevation(RestPoseClass pose) {
  if (pose == RestPoseClass::t_pose) return radians(8);
  return pose == RestPoseClass::a_pose ? radians(3) : 0.0;
}

RestPoseClass class_of_rest(const Character& character, const Humanoid& humanoid) {
  const Landmarks rest(character, humanoid, rest_pose(character.skeleton));
  return usable(rest) ? class_of(rest, dominant_axis(rest.rise())) : RestPoseClass::other;
}

}  // namespace

Status find_frames(const Character& character, const HumanoidOptions& options, Humanoid& humanoid,
                   Diagnostics& diagnostics) {
  Reference reference = find_reference(character, humanoid);
  if (!humanlike(Landmarks(character, humanoid, reference.pose)))
    return input_error(
        character.path,
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
  if (options.neutral_from_motion) refine_from_motion(character, reference, humanoid);
  humanoid.reference = std::move(reference.pose);
  return Done{};
}

}  // namespace ukemi
