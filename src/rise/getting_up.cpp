#include "rise/getting_up.h"

#include <cmath>

#include "rise/rise_by_clip.h"

namespace ukemi {
namespace {

/// A pose for each frame, where a prop has more than one.
void rest_props(Trajectory& trajectory) {
  for (Prop& prop : trajectory.props)
    if (prop.poses.size() > 1) prop.poses.resize(trajectory.frames.size(), prop.poses.back());
}

/// The get-up that the nearest clip leads, where it is in reach; `nearest` says which it is.
std::optional<GetUp> led_get_up(const Riser& riser, const BodyPose& before, const BodyPose& lying, double fps,
                                std::optional<NearestClip>& nearest) {
  if (!riser.library) return std::nullopt;
  const auto entry = nearest_entry(riser.body, *riser.library, before, lying, fps);
  if (!entry) return std::nullopt;
  const RisingClip& clip = (*riser.library)[entry->clip];
  nearest = NearestClip{clip.name,
                        clip.from_s + entry->frame / clip.fps,
                        entry->apart_m,
                        entry->turned_deg,
                        entry->needed_s,
                        entry->in_reach(),
                        0.0,
                        std::nullopt};
  if (!entry->in_reach()) return std::nullopt;
  const WholeBody whole(riser.body, riser.range, riser.skin);
  LedGetUp led = rise_by_clip(whole, riser.range, before, lying, clip, *entry, fps);
  nearest->excess_deg = led.clip_excess_deg;
  nearest->excess_joint = led.clip_excess_joint;
  return std::move(led.get_up);
}

}  // namespace

void hold_last_frame(double until_s, Trajectory& trajectory) {
  const auto frames = static_cast<std::size_t>(std::ceil(until_s * trajectory.fps - 1e-9)) + 1;
  if (frames > trajectory.frames.size()) trajectory.frames.resize(frames, trajectory.frames.back());
  rest_props(trajectory);
}

std::optional<GetUpTimes> add_get_up(const Riser& riser, const GetUpSettings& settings,
                                     Trajectory& trajectory) {
  std::vector<BodyPose>& frames = trajectory.frames;
  const BodyPose lying = frames.back();
  if (lying_of(riser.body, lying) == Lying::upright) return std::nullopt;
  const BodyPose before = frames.size() > 1 ? frames[frames.size() - 2] : lying;
  GetUpSettings at_fps = settings;
  at_fps.fps = trajectory.fps;
  GetUpTimes times;
  auto get_up = led_get_up(riser, before, lying, trajectory.fps, times.clip);
  if (!get_up) {
    auto planned = plan_get_up(riser.body, riser.range, before, lying, riser.standing, riser.skin, at_fps);
    if (!planned) return std::nullopt;
    get_up = std::move(*planned);
  }
  times.route = get_up->route;
  times.begins_s = static_cast<double>(frames.size() - 1) / trajectory.fps;
  times.phases = get_up->phases;
  times.planted = get_up->planted;
  for (GetUpPhase& phase : times.phases) phase.time_s += times.begins_s;
  times.stands_s = times.phases.back().time_s;
  frames.insert(frames.end(), get_up->frames.begin() + 1, get_up->frames.end());
  rest_props(trajectory);
  return times;
}

void add_get_up_marks(const GetUpTimes& times, Clip& clip) {
  clip.marks.push_back({"get_up", times.begins_s});
  for (const GetUpPhase& phase : times.phases) clip.marks.push_back({phase.name, phase.time_s});
}

}  // namespace ukemi
