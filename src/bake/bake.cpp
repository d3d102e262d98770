#include "bake/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "bake/events.h"
#include "bake/outputs.h"
#include "bake/report.h"
#include "bake/search.h"
#include "bake/sheet.h"
#include "bake/skin_lift.h"
#include "bake/stopwatch.h"
#include "base/character_path.h"
#include "base/errors.h"
#include "base/files.h"
#include "clip/extras.h"
#include "clip/frames.h"
#include "clip/root_motion.h"
#include "export/additive.h"
#include "export/append.h"
#include "export/vrma.h"
#include "fbx/fbx.h"
#include "load/load.h"
#include "prepare/setting_table.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

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
  if (settings.additive != Additive::off) facts.additive_from = exported.clip.frames.front();
  facts.on_rest = settings.additive == Additive::rest;
  const Skeleton& skeleton = exported.with_root ? exported.with_root->skeleton : character.skeleton;
  const SegmentFrames frames = frames_of(outcome.prepared.actor(character));
  return with_fps(animation_extras(skeleton, frames, outcome.timeline.clip.marks, facts), exported.clip.fps);
}

/// Whether the joints of a BVH source can turn in every way that their segments do.
bool turns_freely(const BvhSource& bvh, const SegmentFrames& frames) {
  const auto is_rotation = [](BvhChannel channel) { return channel >= BvhChannel::x_rotation; };
  return std::all_of(frames.node.begin(), frames.node.end(), [&](int node) {
    if (node < 0) return true;
    const auto& channels = bvh.channels[static_cast<std::size_t>(node)];
    return std::count_if(channels.begin(), channels.end(), is_rotation) == 3;
  });
}

/// The extras of a BVH's clip. Its joints have axes of their own, which are read from `first_frame`: the file
/// with only the first frame of the clip.
Result<std::string> bvh_extras(const Character& character, const BakeSettings& settings,
                               const BakedClip& outcome, const Clip& clip, const std::string& first_frame) {
  Diagnostics said;
  const auto written = read_bvh(first_frame, "", said);
  if (!written) return written.error();
  auto ranges = ranges_to_tell(outcome.prepared.range);
  if (!ranges) return ranges.error();
  const Humanoid& humanoid = outcome.prepared.humanoid;
  const SegmentFrames frames = frames_of(outcome.prepared.actor(character));
  const Quat turned = character.bvh ? Quat::Identity() : humanoid.world_from_file.rotation;
  SegmentFrames moved =
      moved_frames(character.skeleton, frames, clip.frames.front(), turned, bvh_nodes(character, humanoid),
                   written->skeleton, sample(written->skeleton, written->animations.front(), 0.0));
  // Joints with one or two channels lose part of a rotation, mostly the roll: readers find their own frames.
  if (character.bvh && !turns_freely(*character.bvh, frames)) moved.node.fill(-1);
  const ClipFacts facts{std::string(name(settings.ground.root_motion)), std::nullopt, std::move(*ranges)};
  return with_fps(animation_extras(written->skeleton, moved, outcome.timeline.clip.marks, facts), clip.fps);
}

Result<std::vector<std::uint8_t>> bvh_bytes(const Character& character, const BakeSettings& settings,
                                            const BakedClip& outcome, const Clip& clip,
                                            Diagnostics& diagnostics) {
  const Humanoid& humanoid = outcome.prepared.humanoid;
  BvhOptions options;
  if (settings.bvh_metres_per_unit) options.metres_per_unit = *settings.bvh_metres_per_unit;
  Diagnostics said;
  const auto first_frame =
      write_bvh(character, humanoid, {clip.name, clip.fps, {clip.frames.front()}, {}}, options, said);
  if (!first_frame) return first_frame.error();
  auto extras = bvh_extras(character, settings, outcome, clip, *first_frame);
  if (!extras) return extras.error();
  options.extras_json = std::move(*extras);
  const auto text = write_bvh(character, humanoid, clip, options, diagnostics);
  if (!text) return text.error();
  return bytes_of(*text);
}

Result<std::vector<std::uint8_t>> gltf_bytes(const fs::path& path, const Character& character,
                                             const BakedFile& baked, const Humanoid& humanoid,
                                             const GltfOptions& options) {
  if (output_format(path) != OutputFormat::gltf)
    return write_glb(character, humanoid, baked.reduced, options);
  const auto text = write_gltf(character, humanoid, baked.reduced, options);
  if (!text) return text.error();
  return bytes_of(*text);
}

/// Into the character's own FBX, the earlier output, or a document of its own.
Result<std::vector<std::uint8_t>> fbx_bytes(const fs::path& path, const Character& character,
                                            const BakeSettings& settings, const ExportedClip& exported,
                                            Diagnostics& diagnostics) {
  const bool appends = settings.append && fs::exists(path);
  FbxOptions options;
  options.clip_only = settings.clip_only && !appends;  // what the file holds stays
  std::vector<std::uint8_t> source;
  if (appends || is_fbx(character)) {
    options.source_path = appends ? path : character.path;
    auto bytes = read_file(options.source_path, LoadOptions{}.max_file_bytes);
    if (!bytes) return bytes.error();
    source = std::move(*bytes);
    options.source = source;
  }
  const Character& shown = exported.with_root ? *exported.with_root : character;
  return write_fbx(shown, exported.humanoid, exported.clip, options, diagnostics);
}

/// The humanoid's own bones, for avatars of any proportions.
Result<std::vector<std::uint8_t>> vrma_bytes(const Character& shown, const ExportedClip& exported) {
  std::vector<BodyPose> frames;
  for (const Pose& pose : exported.clip.frames)
    frames.push_back(segments_of(shown.skeleton, exported.humanoid, pose));
  return write_vrma(exported.clip.name, frames, exported.clip.fps);
}

Result<std::vector<std::uint8_t>> output_bytes(const fs::path& path, const Character& character,
                                               const BakeSettings& settings, const BakedFile& baked,
                                               const ExportedClip& exported, Diagnostics& diagnostics) {
  if (output_format(path) == OutputFormat::bvh)
    return bvh_bytes(character, settings, baked.outcome,
                     exported.root_joint < 0 ? exported.clip : exported.on_hips, diagnostics);
  if (output_format(path) == OutputFormat::fbx)
    return fbx_bytes(path, character, settings, exported, diagnostics);
  const Character& shown = exported.with_root ? *exported.with_root : character;
  if (output_format(path) == OutputFormat::vrma) return vrma_bytes(shown, exported);
  if (output_format(path) == OutputFormat::vrm && character.vrm_bones.empty())
    return usage_error(path, "the character is no VRM",
                       "let the name end in .glb, or in .vrma for any VRM avatar");
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

std::vector<int> joints_of_skins(const Character& character) {
  std::set<int> joints;
  for (const Skin& skin : character.skins) joints.insert(skin.joints.begin(), skin.joints.end());
  return {joints.begin(), joints.end()};
}

/// The clip's keys, which keep its joints inside their ranges, and how far they do.
void make_keys(const Character& character, const SegmentFrames& frames, const ExportedClip& exported,
               const BakeSettings& settings, BakedFile& baked) {
  const Skeleton& skeleton = character.skeleton;
  const RangeOfMotion& range = baked.outcome.prepared.range;
  const RangeKeeper keeper(skeleton, frames, range, exported.clip.frames);
  KeyReduction reduction = settings.keys;
  if (settings.all_joints) reduction.joints = joints_of_skins(character);
  baked.reduced =
      reduce_keys(skeleton, exported.clip, exported.humanoid.world_from_file, reduction,
                  [&](std::size_t frame, const Pose& reduced) { return keeper.to_mend(frame, reduced); });
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
  make_keys(exported->with_root ? *exported->with_root : character,
            frames_of(baked.outcome.prepared.actor(character)), *exported, settings, baked);
  if (settings.additive != Additive::off)
    baked.reduced = additive(baked.reduced, exported->clip.frames.front());
  if (settings.additive == Additive::rest) baked.reduced = on_rest(baked.reduced, skeleton);
  for (const fs::path& path : settings.outputs) {
    auto bytes = output_bytes(path, character, settings, baked, *exported, diagnostics);
    if (!bytes) return bytes.error();
    baked.files.push_back({path, std::move(*bytes)});
  }
  if (!settings.events.empty())
    baked.files.push_back({settings.events, bytes_of(events_json(baked.outcome.timeline.clip))});
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
  const auto writes = [&](OutputFormat format) {
    return std::any_of(settings.outputs.begin(), settings.outputs.end(),
                       [format](const fs::path& path) { return output_format(path) == format; });
  };
  const bool to_bvh = writes(OutputFormat::bvh);
  if (settings.smooth_hz && *settings.smooth_hz >= 0.5 * settings.simulation.fps)
    return usage_error(fmt::format("--smooth {} is not below half of the {} frames per second",
                                   *settings.smooth_hz, settings.simulation.fps),
                       "give a lower cut-off, or more --fps");
  if (settings.additive != Additive::off && to_bvh)
    return usage_error("--additive is for glTF: a BVH cannot say what its motion is added to",
                       "leave out the .bvh, or write it by a bake of its own");
  if (settings.additive != Additive::off && (writes(OutputFormat::fbx) || writes(OutputFormat::vrma)))
    return usage_error("--additive is for glTF: engines that read FBX make a clip additive on import",
                       "leave out --additive, and give the engine frame 0 as base pose");
  if (settings.knockout && behaviour_settings(settings).kind == Behaviour::limp)
    return usage_error("--knockout-at is for a body that lives: a limp one is out from the start",
                       "leave out --knockout-at or --behaviour limp");
  if (settings.append && writes(OutputFormat::vrma))
    return usage_error("--append is for glTF and FBX: a .vrma holds one motion", "leave out the .vrma");
  if (settings.append && to_bvh)
    return usage_error("--append is for glTF and FBX: a BVH holds one motion", "leave out the .bvh");
  return Done{};
}

/// The default duration was too short.
void warn_of_unrest(const BakeSettings& settings, const BakedClip& baked, Diagnostics& diagnostics) {
  const bool hit = baked.prepared.scene.kind != SceneKind::none;
  if (settings.simulation.duration_s || !settings.until_rest || !hit || baked.figures.rest_time_s ||
      baked.behaviour.goes_on)
    return;
  diagnostics.warn(
      "", fmt::format("the clip ends after {:.1f} s, before the body is at rest: give a longer --duration",
                      simulated_s(settings)));
}

/// Says where no clip of the library was in reach, and where one bends joints beyond their ranges.
void warn_of_get_up_clip(const BakedClip& outcome, Diagnostics& diagnostics) {
  constexpr double kNoticed_deg = 5.0;
  if (!outcome.get_up || !outcome.get_up->clip) return;
  const NearestClip& clip = *outcome.get_up->clip;
  const BodyPose& lying = outcome.timeline.trajectory.frames[static_cast<std::size_t>(
      std::lround((outcome.timeline.impact_s + outcome.get_up->begins_s) * outcome.timeline.trajectory.fps))];
  if (!clip.leads)
    diagnostics.warn(
        clip.name,
        fmt::format(
            "the nearest get-up of --get-up-clip begins {:.0f} cm and {:.0f} degrees away from how the "
            "body lies ({}), which takes {:.1f} s to reach and not {:.1f}: the get-up is planned "
            "instead; add one that begins {}",
            100.0 * clip.apart_m, clip.turned_deg, name(lying_of(outcome.prepared.body, lying)),
            clip.needed_s, ClipEntry::kLongest_s, name(lying_of(outcome.prepared.body, lying))));
  else if (clip.excess_deg > kNoticed_deg && clip.excess_joint)
    diagnostics.warn(clip.name,
                     fmt::format("bends '{}' up to {:.0f} degrees beyond its range of motion: it is "
                                 "held at its end",
                                 name(*clip.excess_joint), clip.excess_deg));
}

/// The body was to go on with the start clip, but came to stand.
void warn_of_stopping(const BakedClip& baked, Diagnostics& diagnostics) {
  if (!baked.prepared.behaviour.goes_on || baked.behaviour.goes_on || baked.behaviour.fall_begins_s) return;
  diagnostics.warn(
      "", fmt::format("the body cannot go on with the start clip from here and comes to stand{}; a weaker "
                      "--strength, another --at or another clip may help",
                      baked.returns_s > 0.0 ? ", then is blended into the clip" : ""));
}

}  // namespace

Status check_settings(const std::string& character, const BakeSettings& settings) {
  if (const Status status = check_values(settings); !status) return status.error();
  if (const Status status = check_combinations(settings); !status) return status.error();
  return check_outputs(character, settings);
}

Result<BakedClip> bake(const Character& character, const BakeSettings& settings, Diagnostics& diagnostics,
                       const SearchRun& run) {
  Stopwatch watch;
  auto prepared = prepare_bake(character, settings, diagnostics);
  if (!prepared) return prepared.error();
  const double load_s = watch.lap();
  auto found = search_take(character, settings, *prepared, run, diagnostics);
  if (!found) return found.error();
  warn_of_unrest(settings, *found, diagnostics);
  warn_of_stopping(*found, diagnostics);
  warn_of_get_up_clip(*found, diagnostics);
  warn_of_sinking_skin(character, found->skin, diagnostics);
  found->timings_s.load = load_s;
  found->timings_s.total = watch.total();
  return found;
}

Result<BakedFile> bake_loaded(const Character& character, const BakeSettings& settings,
                              Diagnostics& diagnostics, const SearchRun& run) {
  auto outcome = bake(character, settings, diagnostics, run);
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
                            Diagnostics& diagnostics, const SearchRun& run) {
  if (const Status status = check_settings(character, settings); !status) return status.error();
  Stopwatch watch;
  const auto path = character_path(character);
  if (!path) return path.error();
  const auto loaded = load_character(*path, LoadOptions{}, diagnostics);
  if (!loaded) return loaded.error();
  const double load_s = watch.lap();
  auto baked = bake_loaded(*loaded, settings, diagnostics, run);
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
