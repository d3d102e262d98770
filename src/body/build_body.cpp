#include "body/body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "body/anthropometry.h"
#include "body/ground.h"
#include "body/shapes.h"
#include "body/skin_points.h"

namespace ukemi {
namespace {

// What may stand out of the shapes, over stature: lift_skin_above_floor sees to it. A hand is flat.
constexpr double kUncovered = 0.010, kUncoveredHand = 0.021;
constexpr int kDirections = 64;

Vec3 node_in_segment(const Humanoid& humanoid, const std::vector<Affine>& world, const Rigid& segment,
                     int node) {
  return segment.inverse() * (humanoid.world_from_file * Vec3(world[node].translation()));
}

/// Where each segment ends: the next joint, or crown, finger, toe; from the table where there is neither.
PerSegment<Vec3> segment_ends(const Character& character, const Humanoid& humanoid, const Pose& pose,
                              const BodyPose& segments) {
  const double h = humanoid.height_m;
  const std::vector<Affine> world = world_transforms(character.skeleton, pose);
  PerSegment<Vec3> ends;
  const auto to_next = [&](Segment from, Segment next) {
    ends[index(from)] = segments[index(from)].inverse() * segments[index(next)].translation;
  };
  to_next(Segment::pelvis, Segment::abdomen);
  to_next(Segment::abdomen, Segment::chest);
  to_next(Segment::chest, Segment::head);
  ends[index(Segment::head)] = Vec3(0.0, segment_table(Segment::head, Sex::male).length * h, 0.0);
  if (humanoid.head_top >= 0)
    ends[index(Segment::head)] =
        node_in_segment(humanoid, world, segments[index(Segment::head)], humanoid.head_top);
  const auto side = [&](int which, Segment clavicle, Segment thigh) {
    for (int s = index(clavicle); s < index(clavicle) + 3; ++s) to_next(segment_at(s), segment_at(s + 1));
    for (int s = index(thigh); s < index(thigh) + 2; ++s) to_next(segment_at(s), segment_at(s + 1));
    const int hand = index(clavicle) + 3;
    const int foot = index(thigh) + 2;
    ends[hand] = humanoid.middle_finger[which] >= 0
                     ? node_in_segment(humanoid, world, segments[hand], humanoid.middle_finger[which])
                     : Vec3(0.0, -0.055 * h, 0.0);
    ends[foot] = humanoid.toes[which] >= 0
                     ? node_in_segment(humanoid, world, segments[foot], humanoid.toes[which])
                     : Vec3(0.08 * h, -0.03 * h, 0.0);
  };
  side(0, Segment::clavicle_l, Segment::thigh_l);
  side(1, Segment::clavicle_r, Segment::thigh_r);
  return ends;
}

bool has_joint_length(Segment s) {
  return (s >= Segment::clavicle_l && s != Segment::hand_l && s != Segment::hand_r && s != Segment::foot_l &&
          s != Segment::foot_r);
}

BodySegment weigh(Segment segment, const Vec3& end, double height_m, double mass_kg, Sex sex) {
  const SegmentTable table = segment_table(segment, sex);
  BodySegment result;
  result.mass_kg = table.mass_fraction * mass_kg;
  const double table_length = table.length * height_m;
  // A joint distance that is far from human (a long-armed cartoon) counts; one near zero would give no
  // inertia.
  const double length = has_joint_length(segment) ? std::max(end.norm(), 0.3 * table_length) : table_length;
  switch (segment) {
    case Segment::pelvis:
      result.centre_of_mass = Vec3(0.0, table.centre * table_length, 0.0);
      break;
    case Segment::head:
      result.centre_of_mass =
          Vec3(0.01 * height_m, table.centre * std::max(end.norm(), 0.5 * table_length), 0.0);
      break;
    case Segment::hand_l:
    case Segment::hand_r:
      result.centre_of_mass = end.normalized() * (table.centre * table_length);
      break;
    case Segment::foot_l:
    case Segment::foot_r:
      result.centre_of_mass = Vec3((table.centre - 0.24) * table_length, -0.02 * height_m, 0.0);
      break;
    default:
      result.centre_of_mass = table.centre * end;
  }
  const Vec3 radii = length * table.gyration;
  result.inertia = result.mass_kg * radii.cwiseProduct(radii).asDiagonal().toDenseMatrix();
  return result;
}

/// How far a shape reaches along a world direction.
double reach(const Rigid& segment, const Shape& shape, const Vec3& direction) {
  const Rigid world_from_shape = segment * shape.segment_from_shape;
  const Vec3 d = world_from_shape.rotation.conjugate() * direction;
  const double own = shape.kind == ShapeKind::box ? 0.5 * shape.size.dot(d.cwiseAbs())
                                                  : 0.5 * shape.length * std::abs(d.y()) + shape.radius;
  return direction.dot(world_from_shape.translation) + own;
}

bool is_neighbour(Segment a, Segment b) {
  return a == b || (a != Segment::pelvis && parent_of(a) == b) || (b != Segment::pelvis && parent_of(b) == a);
}

/// How far a segment's skin reaches beyond its own shapes and those of its neighbours, in the direction where
/// it is the farthest.
double uncovered(Segment segment, const std::vector<Vec3>& skin, const BodyPose& segments,
                 const ArticulatedBody& body) {
  double most = 0.0;
  for (int i = 0; i < kDirections; ++i) {
    const Vec3 d = direction(i, kDirections);
    double of_skin = -1e300, of_shapes = -1e300;
    for (const Vec3& point : skin) of_skin = std::max(of_skin, d.dot(segments[index(segment)] * point));
    for (int s = 0; s < kSegmentCount; ++s)
      for (const Shape& shape : body.segments[s].shapes)
        if (is_neighbour(segment, segment_at(s)))
          of_shapes = std::max(of_shapes, reach(segments[s], shape, d));
    most = std::max(most, of_skin - of_shapes);
  }
  return most;
}

constexpr double kHem = 0.85;  // of the shank

/// The hem of a trouser leg moves with the shank, but a foot below it is what stands.
std::vector<Vec3> above_the_ankle(std::vector<Vec3> points, const Vec3& ankle) {
  const auto below = [&ankle](const Vec3& point) { return point.dot(ankle) > kHem * ankle.squaredNorm(); };
  points.erase(std::remove_if(points.begin(), points.end(), below), points.end());
  return points;
}

/// The skin that shapes cover badly gets points of its own on the floor.
void add_floor_points(const PerSegment<std::vector<Vec3>>& skin, const BodyPose& segments,
                      ArticulatedBody& body) {
  for (int s = 0; s < kSegmentCount; ++s) {
    BodySegment& segment = body.segments[s];
    if (segment.shapes.empty() || skin[s].empty()) continue;
    const bool is_hand = segment_at(s) == Segment::hand_l || segment_at(s) == Segment::hand_r;
    const double allowed = (is_hand ? kUncoveredHand : kUncovered) * body.height_m;
    if (uncovered(segment_at(s), skin[s], segments, body) > allowed) segment.floor_points = skin[s];
  }
  for (const auto& [shank, foot] :
       {std::pair(Segment::shank_l, Segment::foot_l), std::pair(Segment::shank_r, Segment::foot_r)}) {
    if (body.segments[index(foot)].shapes.empty()) continue;
    std::vector<Vec3>& points = body.segments[index(shank)].floor_points;
    points = above_the_ankle(std::move(points),
                             segments[index(shank)].inverse() * segments[index(foot)].translation);
  }
}

}  // namespace

Result<ArticulatedBody> build_body(const Character& character, const Humanoid& humanoid, const Pose& pose,
                                   const BodyPose& segments, const BodyOptions& options, Diagnostics&) {
  if (!(humanoid.height_m > 0.0) || !std::isfinite(humanoid.height_m))
    return input_error(character.path, "the character has no height", "give --height");
  ArticulatedBody body;
  body.height_m = humanoid.height_m;
  body.mass_kg = options.mass_kg > 0.0 ? options.mass_kg : default_mass_kg(humanoid.height_m, options.sex);
  const PerSegment<Vec3> ends = segment_ends(character, humanoid, pose, segments);
  const auto skin = skin_of_segments(character, humanoid, pose, segments);
  for (int s = 0; s < kSegmentCount; ++s) {
    const Segment segment = segment_at(s);
    if (!segments[s].translation.allFinite() || !ends[s].allFinite())
      return error_about(std::string(name(segment)),
                         input_error(character.path, "the segment's place is not finite",
                                     "check the file's node transforms"));
    body.segments[s] = weigh(segment, ends[s], body.height_m, body.mass_kg, options.sex);
    if (!humanoid.segments[s].fused())
      body.segments[s].shapes = fit_shapes(segment, ends[s], body.height_m, skin[s]);
  }
  add_floor_points(outermost_skin(character, humanoid, pose, segments, body), segments, body);
  for (int j = 0; j < kJointCount; ++j) {
    const Rigid parent_from_world = segments[index(parent_of(joint_at(j)))].inverse();
    const Rigid& child = segments[index(child_of(joint_at(j)))];
    body.joints[j].anchor_in_parent = parent_from_world * child.translation;
    body.joints[j].fused = humanoid.segments[index(child_of(joint_at(j)))].fused();
    body.joints[j].parent_from_child = parent_from_world * child;
  }
  return body;
}

}  // namespace ukemi
