#include "body/shapes.h"

#include <algorithm>
#include <cmath>

#include "base/quantile.h"
#include "body/skin_points.h"
#include "humanoid/skin.h"

namespace ukemi {
namespace {

constexpr std::size_t kFewestVertices = 12;
constexpr double kTrim = 0.02;    // share of the skin left out at either end of an extent: hair, buckles
constexpr double kInside = 0.85;  // share of a limb's skin within its capsule

struct Proportions {
  double radius;  // over stature
  double width;   // trunk: full width over stature; foot: full width
};

// Radii: capsules of de Leva's masses at 1050 kg/m^3 (limbs, head); trunk and foot widths: DeepMimic's
// humanoid and common adult measures.
Proportions proportions(Segment segment) {
  switch (segment) {
    case Segment::pelvis:
      return {0.062, 0.190};
    case Segment::abdomen:
      return {0.058, 0.165};
    case Segment::chest:
      return {0.064, 0.185};
    case Segment::head:
      return {0.053, 0.0};
    case Segment::clavicle_l:
    case Segment::clavicle_r:
      return {0.025, 0.0};
    case Segment::upperarm_l:
    case Segment::upperarm_r:
      return {0.028, 0.0};
    case Segment::forearm_l:
    case Segment::forearm_r:
      return {0.022, 0.0};
    case Segment::hand_l:
    case Segment::hand_r:
      return {0.016, 0.0};
    case Segment::thigh_l:
    case Segment::thigh_r:
      return {0.044, 0.0};
    case Segment::shank_l:
    case Segment::shank_r:
      return {0.028, 0.0};
    case Segment::foot_l:
    case Segment::foot_r:
      break;
  }
  return {0.020, 0.055};
}

bool is_trunk(Segment s) { return s == Segment::pelvis || s == Segment::abdomen || s == Segment::chest; }
bool is_foot(Segment s) { return s == Segment::foot_l || s == Segment::foot_r; }
bool is_hand(Segment s) { return s == Segment::hand_l || s == Segment::hand_r; }

bool ends_at_joint(Segment s) {
  return s == Segment::shank_l || s == Segment::shank_r || s == Segment::forearm_l || s == Segment::forearm_r;
}

double value_at_share(std::vector<double> values, double share) {
  const double rank = share * static_cast<double>(values.size() - 1) + 0.5;
  return ranked(std::move(values), static_cast<std::size_t>(rank));
}

struct Extent {
  double low, high;
  double middle() const { return 0.5 * (low + high); }
  double size() const { return high - low; }
};

Extent extent(const std::vector<Vec3>& points, int axis, double trim) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const Vec3& p : points) values.push_back(p[axis]);
  return {value_at_share(values, trim), value_at_share(values, 1.0 - trim)};
}

Shape capsule_between(const Vec3& from, const Vec3& to, double radius) {
  Shape shape;
  shape.kind = ShapeKind::capsule;
  shape.radius = radius;
  shape.length = std::max((to - from).norm(), 0.05 * radius);
  shape.segment_from_shape = {shortest_rotation(Vec3::UnitY(), to - from), 0.5 * (from + to)};
  return shape;
}

/// Axis and radius of a limb's skin over the middle of the limb: the axis runs through the middle of the
/// skin, parallel to the bone; most of the skin lies within the radius.
struct LimbFit {
  Vec3 offset = Vec3::Zero();
  double radius = 0.0;
};

LimbFit fit_limb(const Vec3& end, const std::vector<Vec3>& skin, double fallback) {
  const double length2 = end.squaredNorm();
  std::vector<Vec3> aside;
  for (const Vec3& p : skin) {
    const double t = length2 > 0.0 ? p.dot(end) / length2 : 0.0;
    if (t > 0.1 && t < 0.9) aside.push_back(p - t * end);
  }
  LimbFit fit{Vec3::Zero(), fallback};
  if (aside.size() < kFewestVertices) return fit;
  for (int axis = 0; axis < 3; ++axis) fit.offset[axis] = extent(aside, axis, 0.05).middle();
  std::vector<double> distances;
  for (const Vec3& p : aside) distances.push_back((p - fit.offset).norm());
  fit.radius = value_at_share(std::move(distances), kInside);
  return fit;
}

Shape limb(Segment segment, const Vec3& end, double height_m, const std::vector<Vec3>& skin) {
  const double table = proportions(segment).radius * height_m;
  const LimbFit fit = fit_limb(end, skin, table);
  // A hand is flat: half its thickness, whatever its width.
  const bool flat = is_hand(segment) && skin.size() >= kFewestVertices;
  const double fitted =
      flat ? 0.5 * std::min(extent(skin, 0, kTrim).size(), extent(skin, 2, kTrim).size()) : fit.radius;
  const double radius = std::clamp(fitted, 0.3 * table, 2.5 * table);
  const Vec3 along = end.normalized();
  double reach = end.norm();
  if (is_hand(segment)) {
    reach *= 1.9;  // fingertip: the middle finger's base lies about half-way
    std::vector<double> reaches;
    for (const Vec3& p : skin) reaches.push_back(p.dot(along));
    if (reaches.size() >= kFewestVertices) reach = value_at_share(std::move(reaches), 0.98);
  }
  // The caps of shank, forearm and hand end at ankle, wrist and fingertip: the heel is nearer to the ankle
  // than a calf is thick.
  if (ends_at_joint(segment) || is_hand(segment)) reach = std::max(reach - radius, 0.5 * end.norm());
  return capsule_between(fit.offset, fit.offset + reach * along, radius);
}

/// A capsule from side to side about the skin, or of the table's size about `centre`.
Shape side_capsule(const Proportions& table, Vec3 centre, double height_m, const std::vector<Vec3>& skin) {
  double radius = table.radius * height_m;
  double width = table.width * height_m;
  if (skin.size() >= kFewestVertices) {
    const Extent depth = extent(skin, 0, kTrim);
    const Extent across = extent(skin, 2, kTrim);
    radius = std::clamp(0.5 * depth.size(), 0.4 * radius, 2.5 * radius);
    width = std::max(across.size(), 2.05 * radius);
    centre = Vec3(depth.middle(), extent(skin, 1, kTrim).middle(), across.middle());
  }
  const Vec3 half(0.0, 0.0, 0.5 * width - radius);
  return capsule_between(centre - half, centre + half, radius);
}

/// One capsule from side to side, two where the skin is much taller than deep (a chest).
std::vector<Shape> trunk(Segment segment, const Vec3& end, double height_m, const std::vector<Vec3>& skin) {
  const Proportions table = proportions(segment);
  const Vec3 centre = segment == Segment::pelvis ? Vec3(0.0, 0.02 * height_m, 0.0) : Vec3(0.5 * end);
  if (skin.size() >= 2 * kFewestVertices) {
    const Extent up = extent(skin, 1, kTrim);
    if (up.size() > 1.2 * extent(skin, 0, kTrim).size()) {
      std::vector<Vec3> lower;
      std::vector<Vec3> upper;
      for (const Vec3& p : skin) (p.y() < up.middle() ? lower : upper).push_back(p);
      return {side_capsule(table, centre, height_m, lower), side_capsule(table, centre, height_m, upper)};
    }
  }
  return {side_capsule(table, centre, height_m, skin)};
}

Shape head(const Vec3& end, double height_m, const std::vector<Vec3>& skin) {
  const double table = proportions(Segment::head).radius * height_m;
  if (skin.size() < kFewestVertices)
    return capsule_between(0.45 * end, end * (1.0 - table / end.norm()), table);
  const Extent up = extent(skin, 1, 0.01);
  std::vector<Vec3> skull;  // without the neck
  for (const Vec3& p : skin)
    if (p.y() > up.low + 0.4 * up.size()) skull.push_back(p);
  const Extent depth = extent(skull, 0, kTrim);
  const Extent across = extent(skull, 2, kTrim);
  const double radius = std::clamp(0.25 * (depth.size() + across.size()), 0.5 * table, 3.0 * table);
  const double high = up.high - radius;
  const double low = std::min(up.low + 0.3 * up.size() + radius, high - 0.01 * height_m);
  return capsule_between({depth.middle(), low, across.middle()}, {depth.middle(), high, across.middle()},
                         radius);
}

Shape foot(const Vec3& end, double height_m, const std::vector<Vec3>& skin) {
  Extent along{-0.035 * height_m, 0.113 * height_m};
  Extent up{-0.039 * height_m, 0.012 * height_m};
  Extent across{-0.5 * 0.055 * height_m, 0.5 * 0.055 * height_m};
  if (end.x() > 0.02 * height_m) along.high = end.x() + 0.035 * height_m;
  if (skin.size() >= kFewestVertices) {
    along = extent(skin, 0, 0.01);
    up = {extent(skin, 1, 0.01).low, std::min(extent(skin, 1, 0.01).high, 0.012 * height_m)};
    across = extent(skin, 2, 0.02);
  }
  Shape shape;
  shape.kind = ShapeKind::box;
  shape.size = Vec3(along.size(), up.size(), across.size()).cwiseMax(0.015 * height_m);
  shape.segment_from_shape = {Quat::Identity(),
                              {along.middle(), up.low + 0.5 * shape.size.y(), across.middle()}};
  return shape;
}

}  // namespace

PerSegment<std::vector<Vec3>> skin_of_segments(const Character& character, const Humanoid& humanoid,
                                               const Pose& pose, const BodyPose& segments) {
  PerSegment<std::vector<Vec3>> result;
  for_each_skin_vertex(character, humanoid, pose, segments, [&](const SkinVertex& v) {
    if (!is_astray(v.place.norm(), humanoid.height_m)) result[index(v.segment)].push_back(v.place);
  });
  return result;
}

std::vector<Shape> fit_shapes(Segment segment, const Vec3& end, double height_m,
                              const std::vector<Vec3>& skin) {
  if (is_trunk(segment)) return trunk(segment, end, height_m, skin);
  if (segment == Segment::head) return {head(end, height_m, skin)};
  if (is_foot(segment)) return {foot(end, height_m, skin)};
  return {limb(segment, end, height_m, skin)};
}

}  // namespace ukemi
