#include "bake/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "bake/append.h"
#include "bake/clip_timing.h"
#include "bake/exported_clip.h"
#include "bake/impact.h"
#include "bake/outputs.h"
#include "bake/report.h"
#include "bake/settings.h"
#include "bake/sheet.h"
#include "bake/start.h"
#include "base/errors.h"
#include "base/files.h"
#include "behave/ground.h"
#include "body/ground.h"
#include "clip/frames.h"
#include "clip/ground_motion.h"
#include "clip/smooth.h"
#include "export/additive.h"
#include "humanoid/rotations.h"
#include "load/character_path.h"
#include "load/load.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

constexpr double kMostTransforms = 16'777'216.0;  // of a clip: 9 GB while its keys are reduced
const double kStartMargin = radians(3.0);  // how far inside its range every joint of the start pose lies

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

/// Makes every joint of the start pose lie inside its range, by widening the range where it does not.
void widen_for_start(BakeOutcome& outcome, Diagnostics& diagnostics) {
  const PerJoint<SwingTwist> charts = charts_of(outcome.range, rotations_of(outcome.start.segments));
  for (int i = 0; i < kJointCount; ++i) {
    if (outcome.body.joints[i].fused) continue;
    const double outside = excess(outcome.range.joints[i], charts[i]);
    const double widened = widen_to_hold(outcome.range.joints[i], charts[i], kStartMargin);
    if (widened <= 0.0) continue;
    outcome.widened.emplace_back(joint_at(i), widened);
    if (outside > radians(1.0))
      diagnostics.warn(
          std::string(name(joint_at(i))),
          fmt::format("starts {:.1f} degrees outside its range of motion; the range is widened by {:.1f} "
                      "degrees for this bake",
                      degrees(outside), degrees(widened)));
  }
}

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

/// The clip on the character's own skeleton, where the file places the figure.
void make_clip(const Character& character, BakeOutcome& outcome) {
  outcome.ground_lift_max_m = lift_skin_above_floor(
      outcome.simulation.trajectory.frames, outcome.simulation.trajectory.fps,
      outermost_skin(character, outcome.humanoid, outcome.start.pose, outcome.start.segments, outcome.body));
  Trajectory in_file_place = outcome.simulation.trajectory;
  for (BodyPose& frame : in_file_place.frames)
    for (Rigid& segment : frame) segment.translation.y() += outcome.start.floor_m;
  outcome.clip = resample(character, outcome.humanoid, outcome.start.pose, outcome.start.segments,
                          in_file_place, outcome.resample_error);
  outcome.clip.name = outcome.reaction;
  outcome.clip.marks = {{"start", 0.0}, {"impact", 0.0}};
  const SimulationFigures& figures = outcome.simulation.figures;
  const double end_s = outcome.clip.duration_s();
  if (figures.first_ground_contact_s && *figures.first_ground_contact_s <= end_s)
    outcome.clip.marks.push_back({"first_ground_contact", *figures.first_ground_contact_s});
  add_step_marks(outcome.simulation.behaviour.steps, end_s, outcome.clip.marks);
  const auto& fall = outcome.simulation.behaviour.fall_begins_s;
  if (fall && *fall <= end_s) outcome.clip.marks.push_back({"fall_begins", *fall});
  if (figures.rest_time_s && *figures.rest_time_s <= end_s)
    outcome.clip.marks.push_back({"rest", *figures.rest_time_s});
}

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Result<std::vector<std::uint8_t>> bvh_bytes(const Character& character, const BakeSettings& settings,
                                            const BakeOutcome& outcome, const Clip& clip) {
  BvhOptions options;
  if (settings.bvh_metres_per_unit) options.metres_per_unit = *settings.bvh_metres_per_unit;
  const auto text = write_bvh(character, outcome.humanoid, clip, options);
  if (!text) return text.error();
  return bytes_of(*text);
}

std::string extras_of(const Character& character, const BakeSettings& settings, const BakeOutcome& outcome) {
  const SegmentFrames frames =
      segment_frames(character.skeleton, outcome.humanoid, outcome.start.pose, outcome.start.segments);
  return animation_extras(character.skeleton, frames, outcome.clip.marks,
                          {std::string(name(settings.root_motion)), settings.additive});
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
                                               const ExportedClip& exported) {
  if (output_format(path) == OutputFormat::bvh)
    return bvh_bytes(character, settings, baked.outcome,
                     exported.root_joint < 0 ? exported.clip : exported.on_hips);
  const Character& shown = exported.with_root ? *exported.with_root : character;
  GltfOptions options{settings.clip_only, extras_of(character, settings, baked.outcome),
                      path.has_parent_path() ? path.parent_path() : fs::path(".")};
  if (!settings.append || !fs::exists(path))
    return gltf_bytes(path, shown, baked, exported.humanoid, options);
  const auto earlier = file_to_append_to(path, shown);
  if (!earlier) return earlier.error();
  options.clip_only = false;  // what the file holds stays
  return gltf_bytes(path, *earlier, baked, exported.humanoid, options);
}

/// Fills `baked.files`.
Status prepare_files(const Character& character, const BakeSettings& settings, BakedFile& baked) {
  Stopwatch watch;
  auto exported = exported_clip(character, settings, baked.outcome);
  if (!exported) return exported.error();
  const Skeleton& skeleton = exported->with_root ? exported->with_root->skeleton : character.skeleton;
  baked.reduced = reduce_keys(skeleton, exported->clip, exported->humanoid.world_from_file, settings.keys);
  if (settings.additive) baked.reduced = additive(baked.reduced, exported->clip.frames.front());
  for (const fs::path& path : settings.outputs) {
    auto bytes = output_bytes(path, character, settings, baked, *exported);
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

std::string reaction_name(const BakeSettings& settings) {
  if (!settings.reaction.empty()) return settings.reaction;
  std::string from = settings.from;
  std::replace(from.begin(), from.end(), ',', '_');
  return settings.hit + "_" + from;
}

Status check_settings(const std::string& character, const BakeSettings& settings) {
  if (const Status status = check_values(settings); !status) return status.error();
  if (const Status status = check_combinations(settings); !status) return status.error();
  return check_outputs(character, settings);
}

Result<BakeOutcome> prepare_bake(const Character& character, const BakeSettings& settings,
                                 Diagnostics& diagnostics) {
  BakeOutcome outcome;
  outcome.reaction = reaction_name(settings);
  auto range = settings.range ? Result(*settings.range) : load_range_of_motion(settings.region);
  if (!range) return range.error();
  outcome.range = std::move(*range);
  auto humanoid = map_humanoid(character, settings.humanoid, diagnostics);
  if (!humanoid) return humanoid.error();
  outcome.humanoid = std::move(*humanoid);
  auto start = start_of(character, outcome.humanoid, settings, diagnostics);
  if (!start) return start.error();
  outcome.start = std::move(*start);
  if (settings.recover_s && settings.recover_to == RecoverTo::clip && !outcome.start.motion)
    return usage_error("--to clip needs a start clip to go back to", "add --clip NAME, or take --to rest");
  auto body = build_body(character, outcome.humanoid, outcome.start.pose, outcome.start.segments,
                         BodyOptions{settings.mass_kg.value_or(0.0), settings.sex}, diagnostics);
  if (!body) return body.error();
  outcome.body = std::move(*body);
  widen_for_start(outcome, diagnostics);
  auto thresholds = load_active_thresholds(settings.active_file);
  if (!thresholds) return thresholds.error();
  outcome.thresholds = *thresholds;
  auto strength = muscle_strength(outcome.body, settings.sex, settings.muscle);
  if (!strength) return strength.error();
  outcome.strength = *strength;
  outcome.behaviour = behaviour_settings(settings);
  auto scene = scene_of(settings, outcome.start.segments[index(Segment::pelvis)].rotation);
  if (!scene) return scene.error();
  outcome.scene = *scene;
  return outcome;
}

BehaviourSettings behaviour_settings(const BakeSettings& settings) {
  BehaviourSettings behaviour;
  const bool fixed = settings.simulation.fixed_hz > 0.0;
  behaviour.kind = settings.behaviour.value_or(fixed ? Behaviour::limp : Behaviour::alert);
  behaviour.most_steps = static_cast<int>(settings.most_steps);
  behaviour.latency_s = settings.latency_s;
  behaviour.muscle = settings.muscle;
  behaviour.seed = static_cast<std::uint64_t>(settings.seed);
  return behaviour;
}

SimulationInput simulation_input(const BakeOutcome& prepared, const Scene& scene,
                                 const SimulationSettings& settings) {
  return {prepared.body,
          prepared.range,
          prepared.thresholds,
          prepared.strength,
          prepared.start.state,
          scene,
          settings,
          behaviour_of(prepared.body, prepared.start.state.segments, scene, prepared.behaviour, settings)};
}

Result<BakeOutcome> bake(const Character& character, const BakeSettings& settings, Diagnostics& diagnostics) {
  Stopwatch watch;
  auto prepared = prepare_bake(character, settings, diagnostics);
  if (!prepared) return prepared.error();
  BakeOutcome outcome = std::move(*prepared);
  outcome.timings_s.load = watch.lap();
  auto simulation = simulate(simulation_input(outcome, outcome.scene, settings.simulation), diagnostics);
  if (!simulation) return simulation.error();
  outcome.simulation = std::move(*simulation);
  if (settings.until_rest)
    trim_still_tail(outcome.simulation.trajectory, outcome.simulation.figures.rest_time_s, settings.hold_s);
  if (outcome.behaviour.kind != Behaviour::limp)
    end_in_start_pose(outcome.start.state.segments, outcome.simulation.behaviour,
                      outcome.simulation.trajectory);
  outcome.timings_s.simulate = watch.lap();
  if (const Status status = check_clip_size(character, settings, outcome.simulation.trajectory); !status)
    return status.error();
  make_clip(character, outcome);
  if (settings.extra_bones_play) play_extra_bones(character, outcome);
  if (settings.smooth_hz) smooth(outcome.clip, *settings.smooth_hz);
  add_lead(character, settings, outcome);
  add_recovery(character, settings, outcome);
  outcome.timings_s.resample = watch.lap();
  outcome.timings_s.total = watch.total();
  return outcome;
}

Result<BakedFile> bake_loaded(const Character& character, const BakeSettings& settings,
                              Diagnostics& diagnostics) {
  auto outcome = bake(character, settings, diagnostics);
  if (!outcome) return outcome.error();
  BakedFile baked{std::move(*outcome), {}, {}, {}, {}};
  if (const Status status = prepare_files(character, settings, baked); !status) return status.error();
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
  baked->report = report_json(character, *loaded, settings, baked->outcome, baked->reduced, diagnostics,
                              baked->root_curve);
  if (!settings.report.empty())
    if (const Status status = files.add(settings.report, baked->report); !status) return status.error();
  if (const Status status = files.commit(); !status) return status.error();
  return baked;
}

}  // namespace ukemi
