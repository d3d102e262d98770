#include "simulate/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.h"

namespace ukemi {
namespace {

constexpr double kHuge = 1e9;
constexpr double kMaxRate_hz = 1e5;

Error input(std::string_view part, std::string what, std::string fix) {
  return error_about(std::string(part), input_error({}, std::move(what), std::move(fix)));
}

/// False for what is not a number, too.
bool within(double value, double low, double high) { return value >= low && value <= high; }

std::optional<Error> fault_of(const SimulationSettings& s) {
  if (!(duration_of(s) > 0.0)) return usage_error("the duration must be above 0 s", "give --duration");
  if (!(s.fps > 0.0)) return usage_error("the frame rate must be above 0", "give --fps");
  if (!(duration_of(s) * s.fps <= kMaxFrames))
    return usage_error(fmt::format("{:g} s at {:g} frames per second are more than {:g} frames",
                                   duration_of(s), s.fps, kMaxFrames),
                       "give a shorter --duration or a lower --fps");
  if (!within(s.fixed_hz, 0.0, kMaxRate_hz))
    return usage_error(fmt::format("the rate must be above 0 and at most {:g} Hz", kMaxRate_hz),
                       "give --rate fixed:480");
  const double h = s.fixed_hz > 0.0 ? 1.0 / s.fixed_hz : 1.0 / 120.0;
  if (s.active == Active::explicit_torque && s.active_k * h > kMaxExplicitGain)
    return usage_error(
        fmt::format("the explicit active restriction is unstable at k = {:g} 1/s with steps of {:.4g} s",
                    s.active_k, h),
        fmt::format("use --active implicit, k up to {:g}, or a higher --rate", kMaxExplicitGain / h));
  if (s.active != Active::off && (!(s.active_k > 0.0) || !std::isfinite(s.active_k)))
    return usage_error("the active restriction's k must be above 0", "give --active-k, or --active off");
  if (!within(tone_of(s), 0.0, 1.0))
    return usage_error("the stiffness must lie within 0 to 1", "give --stiffness");
  if (!within(damping_of(s), 0.0, kHuge))
    return usage_error("the damping must not be negative", "give --damping");
  if (!within(s.tone_fade_s, 0.0, kHuge) || !within(s.active_delay_s, 0.0, kHuge))
    return usage_error("the times of stiffness and active restriction must not be negative",
                       "give --stiffness-fade or --active-delay");
  if (!within(s.gravity, -kHuge, kHuge)) return usage_error("gravity is not a number", "give it in m/s^2");
  return std::nullopt;
}

std::optional<Error> fault_of(const Scene& s) {
  if (!(s.direction.norm() > 0.5) || !s.direction.allFinite())
    return usage_error("the blow has no direction", "give --from");
  const bool has_ball = s.kind == SceneKind::ball || s.kind == SceneKind::box || s.kind == SceneKind::slope;
  const double least = std::numeric_limits<double>::min();
  if (has_ball && !(within(s.ball_mass_kg, least, kHuge) && within(s.ball_radius_m, least, kHuge) &&
                    within(s.ball_speed_m_s, 0.0, kHuge)))
    return usage_error("the ball's mass, radius and speed must be above 0",
                       "give --ball-mass, --ball-radius, --ball-speed");
  if (s.kind == SceneKind::slope) {
    if (!within(s.slope_rad, radians(0.1), radians(89.0)))
      return usage_error("the slope must lie between 0 and 90 degrees", "give --slope-deg");
    if (Vec3(s.direction.x(), 0.0, s.direction.z()).norm() < 1e-6)
      return usage_error("a ramp cannot come from straight above", "give another --from, or --scene ball");
  }
  for (const double number :
       {s.push_force_n, s.push_duration_s, s.impulse_n_s, s.fall_height_m, s.tip_speed_m_s})
    if (!within(number, 0.0, kHuge))
      return usage_error("a number of the scene is negative or not finite", "correct it");
  return std::nullopt;
}

std::optional<Error> fault_of(Segment segment, const BodySegment& part) {
  const char* fix = "give --mass and --height, or map other nodes";
  if (!(part.mass_kg > 0.0) || !std::isfinite(part.mass_kg) || !part.centre_of_mass.allFinite())
    return input(name(segment), "has no mass", fix);
  const Vec3 inertia = part.inertia.diagonal();
  if (!part.inertia.allFinite() || !(inertia.minCoeff() > 0.0))
    return input(name(segment), "has no moment of inertia", fix);
  for (const Shape& shape : part.shapes) {
    const bool box = shape.kind == ShapeKind::box;
    const double least = box ? shape.size.minCoeff() : shape.radius;
    const double most = box ? shape.size.maxCoeff() : shape.radius + shape.length;
    if (!(least > 0.0) || !within(box ? 0.0 : shape.length, 0.0, kHuge) || !(most < kHuge))
      return input(name(segment), "has a shape without size", fix);
  }
  return std::nullopt;
}

std::optional<Error> fault_of(const ArticulatedBody& body, const StartState& start) {
  for (int s = 0; s < kSegmentCount; ++s) {
    const Segment segment = segment_at(s);
    if (auto fault = fault_of(segment, body.segments[s])) return fault;
    const Rigid& at = start.segments[s];
    if (!at.translation.allFinite() || !start.linear_velocity[s].allFinite() ||
        !start.angular_velocity[s].allFinite() || !(std::abs(at.rotation.norm() - 1.0) < 0.1))
      return input(name(segment), "starts at no place", "check the file's node transforms, or give --pose");
  }
  return std::nullopt;
}

std::optional<Error> fault_of(const RangeOfMotion& range) {
  for (int j = 0; j < kJointCount; ++j) {
    const JointRange& joint = range.joints[j];
    const bool finite = std::all_of(joint.polygon.begin(), joint.polygon.end(),
                                    [](const Vec2& corner) { return corner.allFinite(); });
    if (joint.polygon.size() < 3 || !finite || !(joint.twist_min <= joint.twist_max))
      return input(name(joint_at(j)), "has no range of motion", "give --region human, or correct the file");
  }
  return std::nullopt;
}

}  // namespace

std::optional<Error> fault_of(const SimulationInput& input) {
  if (auto fault = fault_of(input.settings)) return fault;
  if (auto fault = fault_of(input.scene)) return fault;
  if (auto fault = fault_of(input.body, input.start)) return fault;
  return fault_of(input.range);
}

}  // namespace ukemi
