#include "body/ground.h"

#include <algorithm>
#include <cmath>

#include "body/skin_points.h"

namespace ukemi {
namespace {

constexpr int kDirections = 64;         // in which outermost points are sought
constexpr double kAllowedDip = 0.005;   // m
constexpr double kMostLift = 0.040;     // m
constexpr double kSmoothing_s = 0.1;    // to either side
constexpr double kLiftSpeed = 0.1;      // m/s, from the first frame on, of up to 40 mm; faster of more
constexpr double kLiftSpeedMost = 1.5;  // m/s, of skin that sinks fast: a tail, a coat
constexpr double kUnseen = 0.010;       // m by which such skin may sink deeper than is allowed

double lowest(const BodyPose& frame, const PerSegment<std::vector<Vec3>>& skin) {
  double low = 0.0;
  for (int s = 0; s < kSegmentCount; ++s) {
    const Vec3 up = frame[s].rotation.conjugate() * Vec3::UnitY();
    for (const Vec3& point : skin[s]) low = std::min(low, frame[s].translation.y() + up.dot(point));
  }
  return low;
}

/// Speed, m/s, at which a lift has to grow from the first frame on so that no skin sinks more than kUnseen
/// deeper than is allowed and than it does in the first frame. `needed`: lift that each frame asks for, m.
double speed_of_sinking(const std::vector<double>& needed, double fps) {
  double speed = 0.0;
  for (std::size_t i = 1; i < needed.size(); ++i)
    speed = std::max(speed, (needed[i] - needed[0] - kUnseen) * fps / static_cast<double>(i));
  return std::min(speed, kLiftSpeedMost);
}

}  // namespace

PerSegment<std::vector<Vec3>> outermost_skin(const Character& character, const Humanoid& humanoid,
                                             const Pose& pose, const BodyPose& segments,
                                             const ArticulatedBody& body) {
  PerSegment<std::vector<Vec3>> skin;
  for_each_skin_vertex(character, humanoid, pose, segments, [&](const SkinVertex& v) {
    if (is_body(v, body)) skin[index(v.segment)].push_back(v.place);
  });
  for (std::vector<Vec3>& points : skin) {
    std::vector<Vec3> far_out;
    for (const std::size_t i : outermost(points, kDirections)) far_out.push_back(points[i]);
    points = std::move(far_out);
  }
  return skin;
}

std::vector<double> lifts(const std::vector<double>& depth_m, double allowed_m, double most_m, double fps) {
  const int count = static_cast<int>(depth_m.size());
  const int reach = static_cast<int>(std::lround(kSmoothing_s * fps));
  std::vector<double> needed;
  for (const double depth : depth_m) needed.push_back(std::clamp(depth - allowed_m, 0.0, most_m));
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
  const double fastest = speed_of_sinking(needed, fps);
  std::vector<double> result;
  for (int i = 0; i < count; ++i) {
    const double mean = around(largest, i, [](auto first, auto last) {
      double sum = 0.0;
      for (auto it = first; it != last; ++it) sum += *it;
      return sum / static_cast<double>(last - first);
    });
    const double speed = std::max(kLiftSpeed * std::max(1.0, mean / kMostLift), fastest);
    result.push_back(std::min(mean, speed * i / fps));
  }
  return result;
}

double lift_skin_above_floor(std::vector<BodyPose>& frames, double fps,
                             const PerSegment<std::vector<Vec3>>& skin) {
  std::vector<double> depths;
  for (const BodyPose& frame : frames) depths.push_back(-lowest(frame, skin));
  const std::vector<double> up = lifts(depths, kAllowedDip, kMostLift, fps);
  double most = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (Rigid& segment : frames[i]) segment.translation.y() += up[i];
    most = std::max(most, up[i]);
  }
  return most;
}

}  // namespace ukemi
