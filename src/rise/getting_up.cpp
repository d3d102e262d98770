#include "rise/getting_up.h"

#include <cmath>

namespace ukemi {
namespace {

/// A pose for each frame, where a prop has more than one.
void rest_props(Trajectory& trajectory) {
  for (Prop& prop : trajectory.props)
    if (prop.poses.size() > 1) prop.poses.resize(trajectory.frames.size(), prop.poses.back());
}

}  // namespace

void hold_last_frame(double until_s, Trajectory& trajectory) {
  const auto frames = static_cast<std::size_t>(std::ceil(until_s * trajectory.fps - 1e-9)) + 1;
  if (frames > trajectory.frames.size()) trajectory.frames.resize(frames, trajectory.frames.back());
  rest_props(trajectory);
}

std::optional<GetUpTimes> add_get_up(const ArticulatedBody& body, const RangeOfMotion& range,
                                     const BodyPose& standing,
                                     const PerSegment<std::vector<Vec3>>& outermost_skin,
                                     const GetUpSettings& settings, Trajectory& trajectory) {
  std::vector<BodyPose>& frames = trajectory.frames;
  const BodyPose lying = frames.back();
  if (lying_of(body, lying) == Lying::upright) return std::nullopt;
  const BodyPose before = frames.size() > 1 ? frames[frames.size() - 2] : lying;
  GetUpSettings at_fps = settings;
  at_fps.fps = trajectory.fps;
  auto planned = plan_get_up(body, range, before, lying, standing, outermost_skin, at_fps);
  if (!planned) return std::nullopt;
  GetUpTimes times;
  times.route = planned->route;
  times.begins_s = static_cast<double>(frames.size() - 1) / trajectory.fps;
  times.phases = planned->phases;
  times.planted = planned->planted;
  for (GetUpPhase& phase : times.phases) phase.time_s += times.begins_s;
  times.stands_s = times.phases.back().time_s;
  frames.insert(frames.end(), planned->frames.begin() + 1, planned->frames.end());
  rest_props(trajectory);
  return times;
}

void add_get_up_marks(const GetUpTimes& times, Clip& clip) {
  clip.marks.push_back({"get_up", times.begins_s});
  for (const GetUpPhase& phase : times.phases) clip.marks.push_back({phase.name, phase.time_s});
}

}  // namespace ukemi
