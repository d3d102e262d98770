#include "body/ground.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "body/shapes.h"

namespace ukemi {
namespace {

constexpr double kFarOut = 0.023;      // over stature: 40 mm of a man
constexpr int kDirections = 64;        // in which outermost points are sought
constexpr double kAllowedDip = 0.005;  // m
constexpr double kMostLift = 0.040;    // m
constexpr double kSmoothing_s = 0.1;   // to either side
constexpr double kLiftSpeed = 0.1;     // m/s, from the first frame on

double distance_from(const Shape& shape, const Vec3& point) {
  const Vec3 p = shape.segment_from_shape.inverse() * point;
  if (shape.kind == ShapeKind::box) return (p.cwiseAbs() - 0.5 * shape.size).cwiseMax(0.0).norm();
  const double along = std::clamp(p.y(), -0.5 * shape.length, 0.5 * shape.length);
  return (p - Vec3(0.0, along, 0.0)).norm() - shape.radius;
}

/// Evenly spread unit vectors: a Fibonacci lattice on the sphere.
Vec3 direction(int i) {
  const double golden = kPi * (3.0 - std::sqrt(5.0));
  const double y = 1.0 - (2.0 * i + 1.0) / kDirections;
  const double ring = std::sqrt(1.0 - y * y);
  return {ring * std::cos(golden * i), y, ring * std::sin(golden * i)};
}

std::vector<Vec3> outermost(const std::vector<Vec3>& points) {
  std::set<std::size_t> chosen;
  for (int i = 0; i < kDirections && !points.empty(); ++i) {
    const Vec3 d = direction(i);
    const auto best = std::max_element(points.begin(), points.end(),
                                       [&](const Vec3& a, const Vec3& b) { return a.dot(d) < b.dot(d); });
    chosen.insert(static_cast<std::size_t>(best - points.begin()));
  }
  std::vector<Vec3> result;
  for (const std::size_t i : chosen) result.push_back(points[i]);
  return result;
}

double lowest(const BodyPose& frame, const PerSegment<std::vector<Vec3>>& skin) {
  double low = 0.0;
  for (int s = 0; s < kSegmentCount; ++s) {
    const Vec3 up = frame[s].rotation.conjugate() * Vec3::UnitY();
    for (const Vec3& point : skin[s]) low = std::min(low, frame[s].translation.y() + up.dot(point));
  }
  return low;
}

}  // namespace

PerSegment<std::vector<Vec3>> outermost_skin(const Character& character, const Humanoid& humanoid,
                                             const Pose& pose, const BodyPose& segments,
                                             const ArticulatedBody& body) {
  PerSegment<std::vector<Vec3>> skin = skin_of_segments(character, humanoid, pose, segments);
  for (int s = 0; s < kSegmentCount; ++s) {
    const std::vector<Shape>& shapes = body.segments[s].shapes;
    std::erase_if(skin[s], [&](const Vec3& point) {
      return std::none_of(shapes.begin(), shapes.end(), [&](const Shape& shape) {
        return distance_from(shape, point) < kFarOut * body.height_m;
      });
    });
    skin[s] = outermost(skin[s]);
  }
  return skin;
}

double lift_skin_above_floor(std::vector<BodyPose>& frames, double fps,
                             const PerSegment<std::vector<Vec3>>& skin) {
  const int count = static_cast<int>(frames.size());
  const int reach = static_cast<int>(std::lround(kSmoothing_s * fps));
  std::vector<double> needed;
  for (const BodyPose& frame : frames)
    needed.push_back(std::clamp(-lowest(frame, skin) - kAllowedDip, 0.0, kMostLift));
  // The mean of the largest needs around is never below the need itself.
  const auto around = [&](const std::vector<double>& values, int i, auto combine) {
    const auto first = values.begin() + std::max(0, i - reach);
    const auto last = values.begin() + std::min(count, i + reach + 1);
    return combine(first, last);
  };
  std::vector<double> largest;
  for (int i = 0; i < count; ++i)
    largest.push_back(
        around(needed, i, [](auto first, auto last) { return *std::max_element(first, last); }));
  double most = 0.0;
  for (int i = 0; i < count; ++i) {
    const double mean = around(largest, i, [](auto first, auto last) {
      double sum = 0.0;
      for (auto it = first; it != last; ++it) sum += *it;
      return sum / static_cast<double>(last - first);
    });
    const double lift = std::min(mean, kLiftSpeed * i / fps);
    for (Rigid& segment : frames[i]) segment.translation.y() += lift;
    most = std::max(most, lift);
  }
  return most;
}

}  // namespace ukemi
