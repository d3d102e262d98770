#include "bake/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "bake/append.h"
#include "bake/outputs.h"
#include "bake/report.h"
#include "bake/score.h"
#include "bake/setting_table.h"
#include "bake/sheet.h"
#include "base/character_path.h"
#include "base/errors.h"
#include "base/files.h"
#include "behave/ground.h"
#include "body/ground.h"
#include "clip/frames.h"
#include "clip/lead.h"
#include "clip/recovery.h"
#include "clip/root_motion.h"
#include "clip/smooth.h"
#include "export/additive.h"
#include "load/load.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

constexpr double kMostTransforms = 16'777'216.0;  // of a clip: 9 GB while its keys are reduced

/// Wall-clock time of the stages.
class Stopwatch {
 public:
  /// Seconds since the last lap.
  double lap() {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }
  double total() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

/// Keeps `hold_s` after the moment everything rests.
void trim_still_tail(Trajectory& trajectory, const std::optional<double>& rest_time_s, double hold_s) {
  if (!rest_time_s) return;
  const double end = std::ceil((*rest_time_s + hold_s) * trajectory.fps - 1e-9);
  const auto frames = static_cast<std::size_t>(std::max(end, 0.0)) + 1;
  if (frames >= trajectory.frames.size()) return;
  trajectory.frames.resize(frames);
  for (Prop& prop : trajectory.props)
    if (prop.poses.size() > frames) prop.poses.resize(frames);
}

/// Who gets up is given 12 s to come to rest first, unless told.
double simulated_s(const BakeSettings& settings) {
  const bool given = settings.simulation.duration_s != SimulationSettings{}.duration_s;
  return settings.get_up_s && !given ? 12.0 : settings.simulation.duration_s;
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

Status check_clip_size(const Character& character, const BakeSettings& settings,
                       const Trajectory& trajectory) {
  const double frames = static_cast<double>(trajectory.frames.size()) +
                        (settings.lead_s + settings.recover_s.value_or(0.0)) * trajectory.fps;
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

/// What the simulation saw, as far as the clip reaches.
void add_marks(const SimulationFigures& figures, const ControllerReport& behaviour, Clip& clip) {
  const double end_s = clip.duration_s();
  if (figures.first_ground_contact_s && *figures.first_ground_contact_s <= end_s)
    clip.marks.push_back({"first_ground_contact", *figures.first_ground_contact_s});
  add_step_marks(behaviour.steps, end_s, clip.marks);
  const auto& fall = behaviour.fall_begins_s;
  if (fall && *fall <= end_s) clip.marks.push_back({"fall_begins", *fall});
  if (figures.rest_time_s && *figures.rest_time_s <= end_s)
    clip.marks.push_back({"rest", *figures.rest_time_s});
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
  if (settings.get_up_s)
    outcome.get_up = add_get_up(
        prepared.body, prepared.range, prepared.start.state.segments, skin,
        {settings.get_up_style, static_cast<std::uint64_t>(settings.seed), trajectory.fps}, trajectory);
  outcome.timeline = timeline_of(actor, std::move(trajectory), prepared.reaction, outcome.resample_error);
  Clip& clip = outcome.timeline.clip;
  add_marks(outcome.figures, outcome.behaviour, clip);
  if (outcome.get_up) add_get_up_marks(*outcome.get_up, clip);
  if (settings.extra_bones_play) play_extra_bones(actor, clip);
  if (settings.smooth_hz) smooth(clip, *settings.smooth_hz);
  add_lead(actor, prepared.scene, gravity, settings.lead_s, outcome.timeline);
  if (!settings.recover_s) return Done{};
  return add_recovery(actor, *settings.recover_s, settings.recover_to, gravity, outcome.timeline);
}

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Result<std::vector<std::uint8_t>> bvh_bytes(const Character& character, const BakeSettings& settings,
                                            const BakedClip& outcome, const Clip& clip,
                                            Diagnostics& diagnostics) {
  BvhOptions options;
  if (settings.bvh_metres_per_unit) options.metres_per_unit = *settings.bvh_metres_per_unit;
  const auto text = write_bvh(character, outcome.prepared.humanoid, clip, options, diagnostics);
  if (!text) return text.error();
  return bytes_of(*text);
}

bool same(const JointRange& a, const JointRange& b) {
  return a.polygon == b.polygon && a.twist_min == b.twist_min && a.twist_max == b.twist_max &&
         a.frame.parent_from_joint.coeffs() == b.frame.parent_from_joint.coeffs() &&
         a.frame.reference.coeffs() == b.frame.reference.coeffs();
}

/// The joints whose range in force is not the human one.
Result<std::vector<std::pair<Joint, JointRange>>> ranges_to_tell(const RangeOfMotion& in_force) {
  const auto human = load_range_of_motion("human");
  if (!human) return human.error();
  std::vector<std::pair<Joint, JointRange>> ranges;
  for (int j = 0; j < kJointCount; ++j)
    if (!same(in_force.joints[j], human->joints[j])) ranges.emplace_back(joint_at(j), in_force.joints[j]);
  return ranges;
}

Result<std::string> extras_of(const Character& character, const BakeSettings& settings,
                              const BakedClip& outcome, const ExportedClip& exported) {
  auto ranges = ranges_to_tell(outcome.prepared.range);
  if (!ranges) return ranges.error();
  ClipFacts facts{std::string(name(settings.ground.root_motion)), std::nullopt, std::move(*ranges)};
  if (settings.additive) facts.additive_from = exported.clip.frames.front();
  const Skeleton& skeleton = exported.with_root ? exported.with_root->skeleton : character.skeleton;
  return animation_extras(skeleton, frames_of(outcome.prepared.actor(character)), outcome.timeline.clip.marks,
                          facts);
}

Result<std::vector<std::uint8_t>> gltf_bytes(const fs::path& path, const Character& character,
                                             const BakedFile& baked, const Humanoid& humanoid,
                                             const GltfOptions& options) {
  if (output_format(path) == OutputFormat::glb) return write_glb(character, humanoid, baked.reduced, options);
  const auto text = write_gltf(character, humanoid, baked.reduced, options);
  if (!text) return text.error();
  return bytes_of(*text);
}

Result<std::vector<std::uint8_t>> output_bytes(const fs::path& path, const Character& character,
                                               const BakeSettings& settings, const BakedFile& baked,
                                               const ExportedClip& exported, Diagnostics& diagnostics) {
  if (output_format(path) == OutputFormat::bvh)
    return bvh_bytes(character, settings, baked.outcome,
                     exported.root_joint < 0 ? exported.clip : exported.on_hips, diagnostics);
  const Character& shown = exported.with_root ? *exported.with_root : character;
  auto extras = extras_of(character, settings, baked.outcome, exported);
  if (!extras) return extras.error();
  GltfOptions options{settings.clip_only, std::move(*extras),
                      path.has_parent_path() ? path.parent_path() : fs::path(".")};
  if (!settings.append || !fs::exists(path))
    return gltf_bytes(path, shown, baked, exported.humanoid, options);
  const auto earlier = file_to_append_to(path, shown);
  if (!earlier) return earlier.error();
  options.clip_only = false;  // what the file holds stays
  return gltf_bytes(path, *earlier, baked, exported.humanoid, options);
}

/// The clip's keys, which keep its joints inside their ranges, and how far they do.
void make_keys(const Skeleton& skeleton, const SegmentFrames& frames, const ExportedClip& exported,
               const BakeSettings& settings, BakedFile& baked) {
  const RangeOfMotion& range = baked.outcome.prepared.range;
  const RangeKeeper keeper(skeleton, frames, range, exported.clip.frames);
  baked.reduced =
      reduce_keys(skeleton, exported.clip, exported.humanoid.world_from_file, settings.keys,
                  [&](std::size_t frame, const Pose& reduced) { return keeper.too_far(frame, reduced); });
  const Animation animation{baked.reduced.name, 0.0, exported.clip.duration_s(), exported.clip.fps,
                            baked.reduced.tracks};
  std::vector<Pose> poses;
  for (std::size_t f = 0; f < exported.clip.frames.size(); ++f)
    poses.push_back(sample(skeleton, animation, static_cast<double>(f) / exported.clip.fps));
  baked.written = clip_limits(skeleton, frames, range, poses);
}

/// Fills `baked.files`.
Status prepare_files(const Character& character, const BakeSettings& settings, BakedFile& baked,
                     Diagnostics& diagnostics) {
  Stopwatch watch;
  auto exported = exported_clip(character, baked.outcome.prepared.humanoid,
                                baked.outcome.prepared.start.segments[index(Segment::pelvis)],
                                baked.outcome.timeline.clip, settings.ground);
  if (!exported) return exported.error();
  const Skeleton& skeleton = exported->with_root ? exported->with_root->skeleton : character.skeleton;
  make_keys(skeleton, frames_of(baked.outcome.prepared.actor(character)), *exported, settings, baked);
  if (settings.additive) baked.reduced = additive(baked.reduced, exported->clip.frames.front());
  for (const fs::path& path : settings.outputs) {
    auto bytes = output_bytes(path, character, settings, baked, *exported, diagnostics);
    if (!bytes) return bytes.error();
    baked.files.push_back({path, std::move(*bytes)});
  }
  baked.root_curve = std::move(exported->root_curve);
  baked.outcome.timings_s.export_ = watch.lap();
  if (!settings.sheet.empty()) {
    auto png = bake_sheet(character, settings, baked.outcome);
    if (!png) return png.error();
    baked.files.push_back({settings.sheet, std::move(*png)});
  }
  if (!settings.preview.empty()) {
    auto webp = bake_preview(character, settings, baked.outcome);
    if (!webp) return webp.error();
    baked.files.push_back({settings.preview, std::move(*webp)});
  }
  baked.outcome.timings_s.render = watch.lap();
  return Done{};
}

/// Settings that do not go together.
Status check_combinations(const BakeSettings& settings) {
  const bool to_bvh = std::any_of(settings.outputs.begin(), settings.outputs.end(), [](const fs::path& path) {
    return output_format(path) == OutputFormat::bvh;
  });
  if (settings.smooth_hz && *settings.smooth_hz >= 0.5 * settings.simulation.fps)
    return usage_error(fmt::format("--smooth {} is not below half of the {} frames per second",
                                   *settings.smooth_hz, settings.simulation.fps),
                       "give a lower cut-off, or more --fps");
  if (settings.additive && to_bvh)
    return usage_error("--additive is for glTF: a BVH cannot say what its motion is added to",
                       "leave the .bvh away, or write it by a bake of its own");
  if (settings.append && to_bvh)
    return usage_error("--append is for glTF: a BVH holds one motion", "leave the .bvh away");
  return Done{};
}

}  // namespace

Status check_settings(const std::string& character, const BakeSettings& settings) {
  if (const Status status = check_values(settings); !status) return status.error();
  if (const Status status = check_combinations(settings); !status) return status.error();
  return check_outputs(character, settings);
}

Result<BakedClip> bake(const Character& character, const BakeSettings& settings, Diagnostics& diagnostics) {
  Stopwatch watch;
  auto prepared = prepare_bake(character, settings, diagnostics);
  if (!prepared) return prepared.error();
  BakedClip outcome;
  outcome.prepared = std::move(*prepared);
  outcome.timings_s.load = watch.lap();
  SimulationSettings simulated = settings.simulation;
  simulated.duration_s = simulated_s(settings);
  auto simulation =
      simulate(simulation_input(outcome.prepared, outcome.prepared.scene, simulated), diagnostics);
  if (!simulation) return simulation.error();
  outcome.limits = simulation->limits;
  outcome.figures = std::move(simulation->figures);
  outcome.behaviour = std::move(simulation->behaviour);
  Trajectory& trajectory = simulation->trajectory;
  const bool blow = outcome.prepared.scene.kind != SceneKind::none;
  const bool gets_up =
      settings.get_up_s && lying_of(outcome.prepared.body, trajectory.frames.back()) != Lying::upright;
  const auto& rest_s = outcome.figures.rest_time_s;
  if ((settings.until_rest && blow) || gets_up)
    trim_still_tail(trajectory, rest_s, gets_up ? *settings.get_up_s : settings.hold_s);
  if (gets_up && rest_s) hold_last_frame(*rest_s + *settings.get_up_s, trajectory);
  if (outcome.prepared.behaviour.kind != Behaviour::limp)
    end_in_start_pose(outcome.prepared.start.state.segments, outcome.behaviour, trajectory);
  outcome.timings_s.simulate = watch.lap();
  if (const Status status = check_clip_size(character, settings, trajectory); !status) return status.error();
  if (const Status status = make_timeline(character, settings, std::move(trajectory), outcome); !status)
    return status.error();
  const auto human = load_range_of_motion("human");
  if (!human) return human.error();
  outcome.human = clip_limits(outcome.prepared.humanoid, *human, outcome.timeline.trajectory.frames);
  outcome.score = human_score(character, settings, outcome);
  outcome.timings_s.resample = watch.lap();
  outcome.timings_s.total = watch.total();
  return outcome;
}

Result<BakedFile> bake_loaded(const Character& character, const BakeSettings& settings,
                              Diagnostics& diagnostics) {
  auto outcome = bake(character, settings, diagnostics);
  if (!outcome) return outcome.error();
  BakedFile baked{std::move(*outcome), {}, {}, {}, {}, {}};
  if (const Status status = prepare_files(character, settings, baked, diagnostics); !status)
    return status.error();
  baked.outcome.timings_s.total += baked.outcome.timings_s.export_ + baked.outcome.timings_s.render;
  return baked;
}

Status add_files(BakedFile& baked, PendingFiles& files) {
  Stopwatch watch;
  for (const OutputFile& file : baked.files)
    if (const Status status = files.add(file.path, file.bytes); !status) return status.error();
  const double write_s = watch.lap();
  baked.outcome.timings_s.export_ += write_s;
  baked.outcome.timings_s.total += write_s;
  return Done{};
}

Status write_files(BakedFile& baked) {
  PendingFiles files;
  if (const Status status = add_files(baked, files); !status) return status.error();
  return files.commit();
}

Result<BakedFile> bake_file(const std::string& character, const BakeSettings& settings,
                            Diagnostics& diagnostics) {
  if (const Status status = check_settings(character, settings); !status) return status.error();
  Stopwatch watch;
  const auto path = character_path(character);
  if (!path) return path.error();
  const auto loaded = load_character(*path, LoadOptions{}, diagnostics);
  if (!loaded) return loaded.error();
  const double load_s = watch.lap();
  auto baked = bake_loaded(*loaded, settings, diagnostics);
  if (!baked) return baked.error();
  PendingFiles files;
  if (const Status status = add_files(*baked, files); !status) return status.error();
  baked->outcome.timings_s.load += load_s;
  baked->outcome.timings_s.total = watch.total();
  baked->report = report_json(character, *loaded, settings, *baked, diagnostics);
  if (!settings.report.empty())
    if (const Status status = files.add(settings.report, baked->report); !status) return status.error();
  if (const Status status = files.commit(); !status) return status.error();
  return baked;
}

}  // namespace ukemi
