#include "humanoid/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/quantile.h"
#include "bones/bones.h"
#include "bones/names.h"
#include "humanoid/assemble.h"
#include "humanoid/landmarks.h"
#include "humanoid/reference.h"
#include "humanoid/refine.h"
#include "humanoid/skin.h"

namespace ukemi {
namespace {

// --- size

/// Distance from the head joint to the node or BVH end site that marks the crown; 0 where there is none.
double head_length(const Character& character, const Humanoid& humanoid, const Landmarks& f) {
  const int head = humanoid.segments[index(Segment::head)].node();
  const Vec3 joint = f.world[head].translation();
  if (humanoid.head_top >= 0) return (f.world[humanoid.head_top].translation() - joint).norm();
  if (character.bvh && character.bvh->end_site[head])
    return (f.world[head] * *character.bvh->end_site[head] - joint).norm();
  return 0.0;
}

/// From the lowest skin of the feet to the highest of the head. Arms, props, wings and the ground do not
/// count, nor do ears, hair and hats that have bones or meshes of their own, except where the head has no
/// other skin.
SkinExtent body_extent(const Character& character, const Humanoid& humanoid, const Landmarks& f,
                       const Vec3& up, const std::vector<char>& astray) {
  const Skeleton& skeleton = character.skeleton;
  const int head = humanoid.segments[index(Segment::head)].node();
  const auto owner = segments_of_nodes(skeleton, humanoid);
  const std::vector<char> skinned = skin_joints(character);
  const auto is_head = [&](int node) {
    return owner[node] == Segment::head && !astray[node] &&
           (!skinned[node] || !skeleton.is_ancestor(head, node));
  };
  const auto is_low = [&](int node) {
    const Segment left = humanoid.carrier(Segment::foot_l), right = humanoid.carrier(Segment::foot_r);
    return !astray[node] && (owner[node] == left || owner[node] == right);
  };
  if (astray[head]) return {};
  const SkinExtent own =
      skin_extent(character, f.world, up, [&](int node) { return node == head && skinned[node] != 0; });
  SkinExtent crown = skin_extent(
      character, f.world, up, [&](int node) { return is_head(node) && (skinned[node] != 0 || !own.found); });
  if (!crown.found)
    crown = skin_extent(character, f.world, up,
                        [&](int node) { return owner[node] == Segment::head && !astray[node]; });
  const SkinExtent soles = skin_extent(character, f.world, up, is_low);
  return {crown.found && soles.found, soles.min, crown.max};
}

/// Whether most bones' skin lies farther from them than a thigh is long, as where the bind pose has another
/// scale than the skeleton: no single one need be astray.
bool most_lie_elsewhere(std::vector<double> distances, double height) {
  constexpr double kThighLength = 0.25;  // of the height
  constexpr std::size_t kFewest = 6;     // bones that carry skin
  if (distances.size() < kFewest) return false;
  const std::size_t middle = distances.size() / 2;
  return ranked(std::move(distances), middle) > kThighLength * height;
}

/// Nodes of the body whose skin lies far away from them: its bind pose has nothing to do with the skeleton.
std::vector<char> skin_astray(const Character& character, const Humanoid& humanoid, const Landmarks& f,
                              double height, Diagnostics& diagnostics) {
  std::vector<char> is_bone(character.skeleton.nodes.size(), 0), astray(is_bone);
  for (const SegmentNodes& segment : humanoid.segments)
    for (const int node : segment.chain) is_bone[static_cast<std::size_t>(node)] = 1;
  std::size_t count = 0;
  CarriedSkin farthest;
  const std::vector<CarriedSkin> carried = carried_skin(character, f.world);
  std::vector<double> of_bones;
  for (const CarriedSkin& skin : carried)
    if (is_bone[static_cast<std::size_t>(skin.node)]) of_bones.push_back(skin.distance);
  const bool all = most_lie_elsewhere(std::move(of_bones), height);
  for (const CarriedSkin& skin : carried) {
    if (!all && !is_astray(skin.distance, height)) continue;
    astray[static_cast<std::size_t>(skin.node)] = 1;
    if (!is_bone[static_cast<std::size_t>(skin.node)]) continue;  // a wing, a spear: as long as it likes
    ++count;
    if (skin.distance > farthest.distance) farthest = skin;
  }
  if (count > 0)
    diagnostics.warn(
        character.path.string(),
        fmt::format(
            "the bind pose of the skin does not fit the skeleton: the skin of {} bone{} lies elsewhere, "
            "that of '{}' {:.1f} times the body's height away; height and shapes are those of the "
            "bones: --height sets the height",
            count, count == 1 ? "" : "s", character.skeleton.label(farthest.node),
            farthest.distance / height));
  return astray;
}

/// Sole to crown, file units. From the skin where its extent fits the skeleton, else from the bones: hip to
/// ankle is 0.491 of the height (de Leva 1996), ankle to head joint 0.84 to 0.91 of it over the rigs that
/// were looked at.
double height_in_file(const Character& character, const Humanoid& humanoid, const Reference& reference,
                      Diagnostics& diagnostics) {
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
  const std::vector<char> astray = skin_astray(character, humanoid, f, height, diagnostics);
  const SkinExtent extent = body_extent(character, humanoid, f, reference.up, astray);
  const double skin_height = extent.max - extent.min;
  if (!extent.found) return height;
  if (skin_height > 0.85 * height && skin_height < 2.1 * height) return skin_height;
  diagnostics.warn(character.path.string(),
                   fmt::format("the skin is {:.2g} times as tall as its skeleton; the height is that of the "
                               "skeleton: --height sets it",
                               skin_height / height));
  return height;
}

struct Unit {
  double metres;
  std::string warning;
};

// A stated unit is believed for a child and for a tall cartoon; asset packs of any other size mean humans,
// and a blow of human strength would do nothing to a body of two tonnes. glTF 2.0 section 3.4: "all linear
// distances are metres".
constexpr double kShortest = 0.3;                          // m
constexpr double kTallest = 3.0;                           // m
constexpr double kLeastHeight = 0.05, kMostHeight = 50.0;  // m: what can be simulated
constexpr double kShortHuman = 1.3, kTallHuman = 2.2;      // m: beyond them a warning

struct UnitChoice {
  double metres;
  double shortest, tallest;  // m, of a figure that may have been drawn in it
};
// The metric ones first: children and cartoons are drawn in them.
constexpr UnitChoice kUnits[] = {{1.0, 0.8, 2.4}, {0.01, 0.8, 2.4}, {0.001, 1.2, 2.4}};
constexpr double kCmu = 0.056444;  // m: cgspeed conversions of the CMU data, 1/0.45 inches
constexpr double kOtherUnits[] = {0.0254, 0.1, kCmu, 0.01 * kCmu, 10.0, 100.0, 1000.0};

/// The unit that makes the figure a human: metres, centimetres or millimetres, else the one that brings it
/// nearest to 1.7 m.
Unit guess_unit(double height) {
  for (const UnitChoice& unit : kUnits)
    if (const double metres = unit.metres * height; metres >= unit.shortest && metres <= unit.tallest)
      return {unit.metres, {}};
  double best = 0.0, best_error = 1e300;
  for (const double unit : kOtherUnits) {
    const double metres = unit * height;
    const double error = std::abs(std::log(metres / 1.7));
    if (metres >= 1.2 && metres <= 2.4 && error < best_error) {
      best = unit;
      best_error = error;
    }
  }
  if (best > 0.0) return {best, {}};
  return {1.741 / height,
          fmt::format("no usual unit makes the character human-sized ({:.4g} file units tall); its height "
                      "is taken as 1.741 m: --height or --unit sets it",
                      height)};
}

std::optional<double> stated_unit(const Character& character) {
  if (character.metres_per_unit) return character.metres_per_unit;
  if (character.format == SourceFormat::gltf) return 1.0;
  return std::nullopt;
}

Unit choose_unit(const Character& character, const HumanoidOptions& options, double height) {
  if (options.height_m)
    return {*options.height_m / height,
            options.metres_per_unit ? "--unit has no effect beside --height, which sets the size" : ""};
  if (options.metres_per_unit) return {*options.metres_per_unit, {}};
  const auto stated = stated_unit(character);
  const bool believed = stated && *stated * height >= kShortest && *stated * height <= kTallest;
  Unit unit = believed ? Unit{*stated, {}} : guess_unit(height);
  const double metres = unit.metres * height;
  if (stated && !believed)
    unit.warning = fmt::format(
        "the file's unit ({} m) would make the character {:.3g} m tall; one unit is taken as "
        "{:.4g} m: --unit or --height sets it",
        *stated, *stated * height, unit.metres);
  else if (metres < kShortHuman || metres > kTallHuman)
    unit.warning = fmt::format(
        "the character is {:.2f} m tall, one file unit being {:.4g} m{}: --unit or --height sets it", metres,
        unit.metres, stated ? "" : " (a guess)");
  return unit;
}

// --- sides

std::optional<Vec3> toe_place(const Character& character, const Humanoid& humanoid, const Landmarks& f,
                              int side) {
  if (humanoid.toes[side] >= 0) return Vec3(f.world[humanoid.toes[side]].translation());
  const int node = humanoid.segments[index(kFoot[side])].node();
  if (node >= 0 && character.bvh && character.bvh->end_site[node])
    return f.world[node] * *character.bvh->end_site[node];
  return std::nullopt;
}

/// Of the length of the legs: how far both toes together must lie before or behind the ankles.
constexpr double kClearlyForward = 0.1;

/// How far both feet together point forwards in a pose, in leg lengths. The line of the hips and the rise of
/// the trunk say where forwards is, so the figure may lie.
double toes_forward(const Character& character, const Humanoid& humanoid, const Landmarks& f) {
  const Vec3 rise = (f.shoulders() - f.hips()).normalized();
  const Vec3 anterior = rise.cross(f.link(Segment::thigh_l, Segment::thigh_r)).normalized();
  double sum = 0.0;
  for (int side = 0; side < 2; ++side) {
    const double leg = f.link(kThigh[side], kShank[side]).norm() + f.link(kShank[side], kFoot[side]).norm();
    if (const auto toe = toe_place(character, humanoid, f, side); toe && leg > 0.0)
      sum += (*toe - f[kFoot[side]]).dot(anterior) / leg;
  }
  return sum;
}

/// The same from the skin around the foot bones: how much farther it reaches forwards than backwards.
double skin_forward(const Character& character, const Humanoid& humanoid, const Landmarks& f) {
  const Vec3 rise = (f.shoulders() - f.hips()).normalized();
  const Vec3 anterior = rise.cross(f.link(Segment::thigh_l, Segment::thigh_r)).normalized();
  double sum = 0.0;
  for (int side = 0; side < 2; ++side) {
    const int foot = humanoid.segments[index(kFoot[side])].node();
    if (foot < 0) continue;
    const SkinExtent extent = skin_extent(character, f.world, anterior, [&](int node) {
      return is_at_or_below(character.skeleton, foot, node);
    });
    const double leg = f.link(kThigh[side], kShank[side]).norm() + f.link(kShank[side], kFoot[side]).norm();
    if (extent.found && leg > 0.0)
      sum += (extent.max + extent.min - 2.0 * f[kFoot[side]].dot(anterior)) / leg;
  }
  return sum;
}

/// How clearly the feet point forwards (> 0) or backwards: of a character in its reference pose, of a motion
/// in the mean of its frames.
double feet_forward(const Character& character, const Humanoid& humanoid, const Reference& reference) {
  constexpr int kMostFrames = 100;
  if (!only_motion(character)) {
    const Landmarks figure(character, humanoid, reference.pose);
    const double toes = toes_forward(character, humanoid, figure);
    return std::abs(toes) < kClearlyForward ? skin_forward(character, humanoid, figure) : toes;
  }
  double sum = 0.0;
  const std::vector<double> times = sample_times(character.animations[0], kMostFrames);
  for (const double t : times)
    sum +=
        toes_forward(character, humanoid,
                     Landmarks(character, humanoid, sample(character.skeleton, character.animations[0], t)));
  return sum / static_cast<double>(times.size());
}

// --- frames

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
    if (const auto toe = toe_place(character, humanoid, figure, side)) {
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

/// How many bones of the limbs carry a name of their side, less those with one of the other side.
int named_sides(const Character& character, const Humanoid& humanoid) {
  int agreeing = 0;
  for (int s = index(Segment::clavicle_l); s < kSegmentCount; ++s) {
    const int node = humanoid.segments[s].node();
    if (node < 0) continue;
    const Side side = read_name(character.skeleton.nodes[node].name).side;
    const Side expected = segment_at(s) < mirror_of(segment_at(s)) ? Side::left : Side::right;
    if (side != Side::none) agreeing += side == expected ? 1 : -1;
  }
  return agreeing;
}

/// Rule 2. Sides come from the user, VRM data or names; where none of them speaks, from the feet.
void choose_sides(const Character& character, const Reference& reference, Humanoid& humanoid,
                  Diagnostics& diagnostics) {
  const std::string by = humanoid.segments[index(Segment::thigh_l)].by;
  const auto exchange = [&](std::string_view why) {
    swap_sides(humanoid);
    diagnostics.warn(character.path.string(), fmt::format("{}: --map with the limbs sets them", why));
  };
  const int agreeing = by == "topology" ? named_sides(character, humanoid) : 0;
  if (agreeing < 0) swap_sides(humanoid);
  const bool stated = by != "topology" || agreeing != 0;
  const Affine pelvis =
      world_transforms(character.skeleton, reference.pose)[humanoid.carrier_node(Segment::pelvis)];
  if (stated && by != "user" && pelvis.linear().determinant() < 0.0)
    exchange("left and right are exchanged against the names: the armature is mirrored");
  const double forward = feet_forward(character, humanoid, reference);
  if (std::abs(forward) < kClearlyForward) {
    if (!stated && forward <= 0.0)
      diagnostics.warn(character.path.string(),
                       "neither names nor feet say which side is left; the figure is taken to face +z: --map "
                       "with the limbs sets them");
    return;
  }
  if (forward > 0.0) return;
  if (!stated)
    swap_sides(humanoid);
  else
    diagnostics.warn(
        character.path.string(),
        fmt::format("with left and right as {} say, the feet point backwards; {} are believed: to "
                    "exchange left and right, name the limbs with --map",
                    by == "user"  ? "you"
                    : by == "vrm" ? "VRM data"
                                  : "the names",
                    by == "user" ? "you" : "they"));
}

/// What named a bone's side (you, VRM data, names): for the warning that it lies on the other side.
std::string_view authority(const std::string& by) {
  if (by == "user") return "you win";
  return by == "vrm" ? "VRM data wins" : "the names win";
}

/// A limb that lies on the other side of the body than its bones say.
void warn_of_limbs_across(const Character& character, const Reference& reference, const Humanoid& humanoid,
                          Diagnostics& diagnostics) {
  constexpr double kClearlyAcross = 0.15;  // of the distance of the shoulders or hips, from the middle
  const Landmarks figure(character, humanoid, reference.pose);
  const Vec3 rise = (figure[Segment::head] - figure[Segment::pelvis]).normalized();
  const Vec3 hips = figure.link(Segment::thigh_l, Segment::thigh_r);
  const Vec3 shoulders = figure.link(Segment::upperarm_l, Segment::upperarm_r);
  const Vec3 right = perpendicular(rise, hips + shoulders);
  const Vec3 middle = figure[Segment::pelvis];
  for (const auto& [left, limb] : {std::pair(Segment::upperarm_l, "arm"), {Segment::thigh_l, "leg"}}) {
    for (const Segment upper : {left, mirror_of(left)}) {
      const bool is_left = upper == left;
      const double outwards = (is_left ? -1.0 : 1.0) * (figure[upper] - middle).dot(right);
      if (outwards > -kClearlyAcross * std::max(hips.norm(), shoulders.norm())) continue;
      const SegmentNodes& bone = humanoid.segments[index(upper)];
      diagnostics.warn(
          character.path.string(),
          fmt::format("the {} {} ('{}') lies on the {} side of the body; {}: --map {}=NODE and --map {}=NODE "
                      "say otherwise",
                      is_left ? "left" : "right", limb, character.skeleton.label(bone.node()),
                      is_left ? "right" : "left", authority(bone.by), name(upper), name(mirror_of(upper))));
    }
  }
}

/// Rotations below a scale that differs by axis shear: no clip of rotations moves such a body as a skeleton.
void warn_of_uneven_scale(const Character& character, const Humanoid& humanoid, Diagnostics& diagnostics) {
  constexpr double kEven = 1.02;
  for (const SegmentNodes& segment : humanoid.segments)
    for (int node = segment.node(); node >= 0; node = character.skeleton.nodes[node].parent) {
      const Vec3 scale = character.skeleton.nodes[node].rest.scale.cwiseAbs();
      if (scale.maxCoeff() <= kEven * scale.minCoeff()) continue;
      diagnostics.warn(
          character.path.string(),
          fmt::format(
              "the scale of '{}' differs by axis ({:.3g} {:.3g} {:.3g}): what hangs on it shears when it "
              "turns, and joints may leave their ranges; apply the scale in the program that made it",
              character.skeleton.label(node), scale.x(), scale.y(), scale.z()));
      return;
    }
}

Status find_frames(const Character& character, const HumanoidOptions& options, Humanoid& humanoid,
                   Diagnostics& diagnostics) {
  Reference reference = find_reference(character, humanoid, options, diagnostics);
  if (!humanlike(Landmarks(character, humanoid, reference.pose)))
    return input_error(
        character.path,
        "not a humanoid: bones were found by name, but no pose of the file has a trunk that rises from "
        "two legs with an arm on each side",
        "if the character is a human, check the bones with --map SEGMENT=NODE");
  choose_sides(character, reference, humanoid, diagnostics);
  warn_of_limbs_across(character, reference, humanoid, diagnostics);
  warn_of_uneven_scale(character, humanoid, diagnostics);
  humanoid.rest_pose = class_of_rest(character, humanoid);
  FrameBuilder builder(character, humanoid, reference);
  builder.build(clavicle_elevation(class_of(builder.figure, reference.up)));
  for (int s = 0; s < kSegmentCount; ++s) {
    const Quat node = rotation_part(builder.figure.world[humanoid.carrier_node(segment_at(s))].linear());
    humanoid.node_from_segment[s] = (node.conjugate() * Quat(builder.frame[s])).normalized();
  }
  const double height = height_in_file(character, humanoid, reference, diagnostics);
  const Unit unit = choose_unit(character, options, height);
  if (height * unit.metres < kLeastHeight || height * unit.metres > kMostHeight)
    return usage_error(
        character.path,
        fmt::format("a unit of {:g} m makes the character {:.3g} m tall", unit.metres, height * unit.metres),
        fmt::format("give a --unit or --height that makes it {:g} to {:g} m tall", kLeastHeight,
                    kMostHeight));
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
