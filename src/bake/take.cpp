#include "bake/take.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/response.h"
#include "bake/score.h"
#include "bake/skin_lift.h"
#include "bake/stopwatch.h"
#include "base/errors.h"
#include "body/ground.h"
#include "body/on_ground.h"
#include "clip/lead.h"
#include "clip/recovery.h"
#include "clip/smooth.h"

namespace ukemi {
namespace {

constexpr double kGoesOn_s = 0.4;                 // of the blend into a start clip that the body goes on with
constexpr double kMostTransforms = 16'777'216.0;  // of a clip: 9 GB while its keys are reduced

void keep_frames(std::size_t frames, Trajectory& trajectory) {
  if (frames >= trajectory.frames.size()) return;
  trajectory.frames.resize(frames);
  for (Prop& prop : trajectory.props)
    if (prop.poses.size() > frames) prop.poses.resize(frames);
}

/// Keeps `hold_s` after the moment everything rests.
void trim_still_tail(Trajectory& trajectory, const std::optional<double>& rest_time_s, double hold_s) {
  if (!rest_time_s) return;
  const double end = std::ceil((*rest_time_s + hold_s) * trajectory.fps - 1e-9);
  keep_frames(static_cast<std::size_t>(std::max(end, 0.0)) + 1, trajectory);
}

/// Farthest that a segment is from another pose's, m (a radian counts as 0.5 m).
double difference(const BodyPose& a, const BodyPose& b) {
  constexpr double kPerRadian_m = 0.5;
  double most = 0.0;
  for (int s = 0; s < kSegmentCount; ++s)
    most = std::max({most, (a[s].translation - b[s].translation).norm(),
                     kPerRadian_m * angle_between(a[s].rotation, b[s].rotation)});
  return most;
}

/// A body that has kept its feet in place comes back to where it started, but for a little: the last frames
/// blend that away, so that the clip ends exactly in its start pose.
void end_in_start_pose(const BodyPose& start, const ControllerReport& behaviour, Trajectory& trajectory) {
  constexpr double kBlend_s = 0.15;
  constexpr double kNear_m = 0.03;
  const bool stayed = behaviour.steps.empty() && !behaviour.fall_begins_s;
  if (!stayed || difference(trajectory.frames.back(), start) > kNear_m) return;
  const auto span = static_cast<std::size_t>(std::lround(kBlend_s * trajectory.fps));
  const std::size_t count = trajectory.frames.size();
  if (count <= span + 1) return;
  for (std::size_t i = count - span; i < count; ++i) {
    const double share = min_jerk(static_cast<double>(i + 1 + span - count) / static_cast<double>(span));
    for (int s = 0; s < kSegmentCount; ++s) {
      Rigid& segment = trajectory.frames[i][s];
      segment = {segment.rotation.slerp(share, start[s].rotation),
                 segment.translation + share * (start[s].translation - segment.translation)};
    }
  }
  trajectory.frames.back() = start;
}

/// Seconds in which a body that lies and lives is seen to breathe.
double breath_s(const Prepared& prepared, const ControllerReport& behaviour) {
  constexpr double kBreath_s = 1.0;
  return prepared.behaviour.breathes && behaviour.fall.settled_s ? kBreath_s : 0.0;
}

Status check_clip_size(const Character& character, const BakeSettings& settings,
                       const Trajectory& trajectory) {
  const double frames = static_cast<double>(trajectory.frames.size()) +
                        (settings.lead_s + settings.recover_s.value_or(kGoesOn_s)) * trajectory.fps;
  const double nodes = character.skeleton.size();
  if (frames * nodes <= kMostTransforms) return Done{};
  return usage_error(fmt::format("{:.0f} frames of {:.0f} nodes are more than {:.0f} transforms", frames,
                                 nodes, kMostTransforms),
                     "give a shorter --duration or a lower --fps, or take a file with fewer nodes");
}

/// lift_left, contact_left, lift_right, ..., lift_left_2: when feet leave the ground and stand on it again.
void add_step_marks(const std::vector<StepTaken>& steps, double end_s, std::vector<Mark>& marks) {
  std::array<int, 2> taken{};
  for (const StepTaken& step : steps) {
    const bool left = step.foot == Segment::foot_l;
    const int nth = ++taken[left ? 0 : 1];
    const std::string side =
        std::string(left ? "_left" : "_right") + (nth > 1 ? fmt::format("_{}", nth) : "");
    if (step.lift_s <= end_s) marks.push_back({"lift" + side, step.lift_s});
    if (step.contact_s && *step.contact_s <= end_s) marks.push_back({"contact" + side, *step.contact_s});
  }
}

void add_contact_marks(const FirstContacts& contacts, double end_s, std::vector<Mark>& marks) {
  const auto add = [&](const char* name, const std::optional<TouchDown>& touch) {
    if (touch && touch->time_s <= end_s) marks.push_back({name, touch->time_s});
  };
  add("hand_contact", contacts.hand);
  add("knee_contact", contacts.knee);
  add("pelvis_contact", contacts.pelvis);
  add("head_contact", contacts.head);
}

/// What the simulation saw, as far as the clip reaches.
void add_marks(const SimulationFigures& figures, const ControllerReport& behaviour, Clip& clip) {
  const double end_s = clip.duration_s();
  if (figures.first_ground_contact_s && *figures.first_ground_contact_s <= end_s)
    clip.marks.push_back({"first_ground_contact", *figures.first_ground_contact_s});
  if (behaviour.knocked_out_s && *behaviour.knocked_out_s <= end_s)
    clip.marks.push_back({"knocked_out", *behaviour.knocked_out_s});
  add_step_marks(behaviour.steps, end_s, clip.marks);
  const auto& fall = behaviour.fall_begins_s;
  if (fall && *fall <= end_s) clip.marks.push_back({"fall_begins", *fall});
  if (figures.rest_time_s && *figures.rest_time_s <= end_s)
    clip.marks.push_back({"rest", *figures.rest_time_s});
}

/// A run ends where the body goes on with its clip.
void end_where_it_goes_on(const std::optional<GoesOn>& goes_on, Trajectory& trajectory) {
  if (goes_on) keep_frames(static_cast<std::size_t>(goes_on->time_s * trajectory.fps + 1e-9) + 1, trajectory);
}

/// How the clip ends: a body that goes on is at the moment of the start clip that it has reached.
Return return_of(const BakeSettings& settings, const ControllerReport& behaviour) {
  Return to{settings.recover_to, std::nullopt};
  if (behaviour.goes_on) to.moment_s = behaviour.goes_on->moment_s;
  return to;
}

/// From the simulated segments to the clip with all that stands before and behind them.
Status make_timeline(const Character& character, const BakeSettings& settings, Trajectory trajectory,
                     BakedClip& outcome) {
  const Prepared& prepared = outcome.prepared;
  const Actor actor = prepared.actor(character);
  const double gravity = settings.simulation.gravity;
  const auto skin = outermost_skin(character, prepared.humanoid, prepared.start.pose, prepared.start.segments,
                                   prepared.body);
  outcome.ground_lift_max_m = lift_skin_above_floor(trajectory.frames, trajectory.fps, skin);
  if (gets_up_after_s(settings))
    outcome.get_up = add_get_up(
        {prepared.body, prepared.range, prepared.start.state.segments, skin, prepared.get_ups.get()},
        {settings.get_up_style, static_cast<std::uint64_t>(settings.seed), trajectory.fps}, trajectory);
  outcome.timeline = timeline_of(actor, std::move(trajectory), prepared.reaction, outcome.resample_error);
  Clip& clip = outcome.timeline.clip;
  add_marks(outcome.figures, outcome.behaviour, clip);
  if (prepared.behaviour.kind != Behaviour::limp)
    add_contact_marks(first_contacts(outcome.figures, outcome.behaviour), clip.duration_s(), clip.marks);
  if (outcome.get_up) add_get_up_marks(*outcome.get_up, clip);
  if (settings.extra_bones_play) play_extra_bones(actor, clip);
  if (settings.smooth_hz) smooth(clip, *settings.smooth_hz);
  const SkinOverFloor blended(character, prepared.humanoid, prepared.body, prepared.start.pose,
                              prepared.start.segments);
  outcome.ground_lift_max_m =
      std::max(outcome.ground_lift_max_m, lift_blended_skin(actor, blended, outcome.timeline));
  add_lead(actor, prepared.scene, gravity, settings.lead_s, outcome.timeline);
  Status status = Done{};
  if (outcome.returns_s > 0.0)
    status = add_recovery(actor, outcome.returns_s, return_of(settings, outcome.behaviour), gravity,
                          outcome.timeline);
  outcome.skin = skin_on_floor(blended, clip.frames);
  return status;
}

}  // namespace

Result<SimulationResult> simulate_take(const BakeSettings& settings, const Prepared& prepared,
                                       const BehaviourSettings& behaviour, Diagnostics& diagnostics) {
  SimulationSettings simulated = settings.simulation;
  simulated.duration_s = simulated_s(settings);
  Diagnostics said;
  const auto run = [&](const BehaviourSettings& lives) {
    said = {};
    return simulate(simulation_input(prepared, prepared.scene, simulated, lives), said);
  };
  auto result = run(behaviour);
  if (behaviour.goes_on && result && result->behaviour.fall_begins_s) {
    // A body that falls while it goes on may come to stand instead.
    const Diagnostics falling = said;
    BehaviourSettings stops = behaviour;
    stops.goes_on.reset();
    auto stopped = run(stops);
    if (stopped && !stopped->behaviour.fall_begins_s)
      result = std::move(stopped);
    else
      said = falling;
  }
  for (const Warning& warning : said.warnings()) diagnostics.warn(warning.subject, warning.what);
  return result;
}

Result<BakedClip> clip_of_take(const Character& character, const BakeSettings& settings,
                               const Prepared& prepared, SimulationResult simulation) {
  BakedClip outcome;
  outcome.prepared = prepared;
  outcome.limits = simulation.limits;
  outcome.figures = std::move(simulation.figures);
  outcome.behaviour = std::move(simulation.behaviour);
  Trajectory& trajectory = simulation.trajectory;
  outcome.returns_s = settings.recover_s.value_or(outcome.behaviour.goes_on ? kGoesOn_s : 0.0);
  end_where_it_goes_on(outcome.behaviour.goes_on, trajectory);
  const bool blow = prepared.scene.kind != SceneKind::none;
  const std::optional<double> get_up_s = gets_up_after_s(settings);
  const bool gets_up = get_up_s && lying_of(prepared.body, trajectory.frames.back()) != Lying::upright;
  const auto& rest_s = outcome.figures.rest_time_s;
  if ((settings.until_rest && blow) || gets_up)
    trim_still_tail(trajectory, rest_s,
                    gets_up ? *get_up_s : settings.hold_s + breath_s(prepared, outcome.behaviour));
  if (gets_up && rest_s) hold_last_frame(*rest_s + *get_up_s, trajectory);
  if (prepared.behaviour.kind != Behaviour::limp)
    end_in_start_pose(prepared.start.state.segments, outcome.behaviour, trajectory);
  if (const Status status = check_clip_size(character, settings, trajectory); !status) return status.error();
  if (const Status status = make_timeline(character, settings, std::move(trajectory), outcome); !status)
    return status.error();
  const auto human = load_range_of_motion("human");
  if (!human) return human.error();
  outcome.human = clip_limits(prepared.humanoid, *human, outcome.timeline.trajectory.frames);
  outcome.score = human_score(character, outcome);
  return outcome;
}

}  // namespace ukemi
