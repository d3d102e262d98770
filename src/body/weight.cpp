#include "body/weight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "body/centre_of_mass.h"
#include "body/on_ground.h"

namespace ukemi {
namespace {

constexpr double kGravity = 9.81;
constexpr double kBears = 0.020 / 1.78;  // of the height
constexpr double kFlesh = 0.050 / 1.78;  // of trunk and thighs, which give
constexpr double kSpan_s = 0.05;         // to either side, of differences

bool is_flesh(Segment segment) {
  for (const Segment flesh :
       {Segment::pelvis, Segment::abdomen, Segment::chest, Segment::thigh_l, Segment::thigh_r})
    if (segment == flesh) return true;
  return false;
}

double outside(const std::vector<Vec2>& hull, const Vec3& place) {
  if (hull.empty()) return std::numeric_limits<double>::infinity();
  if (hull.size() < 3) return (hull.front() - on_ground(place)).norm();
  return beyond(hull, on_ground(place));
}

}  // namespace

std::vector<Vec2> support_of(const ArticulatedBody& body, const PerSegment<std::vector<Vec3>>& skin,
                             const BodyPose& pose) {
  std::vector<Vec2> corners;
  for (int s = 0; s < kSegmentCount; ++s) {
    const double bears_m = body.height_m * (is_flesh(segment_at(s)) ? kFlesh : kBears);
    for (const Vec3& point : skin[s])
      if (const Vec3 place = pose[s] * point; place.y() < bears_m) corners.push_back(on_ground(place));
  }
  return corners.size() < 3 ? corners : convex_hull(corners);
}

std::vector<WeightOffset> weight_offsets(const ArticulatedBody& body,
                                         const PerSegment<std::vector<Vec3>>& skin,
                                         const std::vector<BodyPose>& frames, double fps) {
  std::vector<Vec3> mass;
  for (const BodyPose& frame : frames) mass.push_back(centre_of_mass(body, frame));
  const int last = static_cast<int>(frames.size()) - 1;
  const int span = std::max(1, static_cast<int>(std::lround(kSpan_s * fps)));
  const auto at = [&](int f) { return mass[static_cast<std::size_t>(std::clamp(f, 0, last))]; };
  std::vector<WeightOffset> offsets;
  for (int f = 0; f <= last; ++f) {
    const std::vector<Vec2> hull = support_of(body, skin, frames[static_cast<std::size_t>(f)]);
    const Vec3 c = at(f);
    const Vec3 v = fps / (2.0 * span) * (at(f + span) - at(f - span));
    offsets.push_back({outside(hull, c), outside(hull, c + std::sqrt(c.y() / kGravity) * v)});
  }
  return offsets;
}

}  // namespace ukemi
