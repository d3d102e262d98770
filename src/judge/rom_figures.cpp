#include "judge/rom_figures.h"

#include <algorithm>

#include "base/animation.h"
#include "base/native_rate.h"
#include "clip/names.h"
#include "clip/start.h"
#include "humanoid/rotations.h"

namespace ukemi {
namespace {

constexpr double kMaxCheckedRate = 60.0;  // frames per second

using Rotations = std::vector<PerSegment<Quat>>;

Rotations stored_rotations(const Skeleton& skeleton, const SegmentFrames& frames,
                           const std::vector<Pose>& poses) {
  Rotations result;
  for (const Pose& pose : poses) result.push_back(rotations_of(skeleton, frames, pose));
  return result;
}

Rotations canonical_rotations(const Skeleton& skeleton, const Humanoid& humanoid,
                              const std::vector<Pose>& poses) {
  Rotations result;
  for (const Pose& pose : poses)
    result.push_back(rotations_of(canonical_segments_of(skeleton, humanoid, pose)));
  return result;
}

RomPaths paths_of(const Rotations& rotations, const RangeOfMotion& range, const PerSegment<bool>& fused,
                  Rolls rolls) {
  RomPaths paths;
  paths.rolls = rolls;
  for (const PerSegment<Quat>& frame : rotations) {
    const PerJoint<SwingTwist> charts = charts_of(range, frame);
    for (int j = 0; j < kJointCount; ++j) {
      if (fused[index(child_of(joint_at(j)))]) continue;
      paths.joints[j].charts.push_back(charts[j]);
      paths.joints[j].excess_deg.push_back(degrees(excess(range.joints[j], charts[j])));
    }
  }
  return paths;
}

}  // namespace

std::string_view name(Rolls rolls) {
  switch (rolls) {
    case Rolls::stored:
      return "stored";
    case Rolls::canonical:
      return "canonical";
    case Rolls::first_frame:
      break;
  }
  return "first-frame";
}

RomPaths rom_paths(const Skeleton& skeleton, const Humanoid& humanoid, const RangeOfMotion& range,
                   const std::vector<Pose>& poses, const std::optional<SegmentFrames>& stored) {
  PerSegment<bool> fused;
  for (int i = 0; i < kSegmentCount; ++i)
    fused[i] = stored ? stored->node[i] < 0 : humanoid.segments[i].fused();
  if (stored) return paths_of(stored_rotations(skeleton, *stored, poses), range, fused, Rolls::stored);
  RomPaths canonical =
      paths_of(canonical_rotations(skeleton, humanoid, poses), range, fused, Rolls::canonical);
  if (poses.size() < 2) return canonical;
  const SegmentFrames first = segment_frames(skeleton, humanoid, poses.front(),
                                             canonical_segments_of(skeleton, humanoid, poses.front()));
  RomPaths fixed = paths_of(stored_rotations(skeleton, first, poses), range, fused, Rolls::first_frame);
  return rom_figures(fixed).over_1deg_fraction < rom_figures(canonical).over_1deg_fraction ? fixed
                                                                                           : canonical;
}

RangeOfMotion range_of_clip(const RangeOfMotion& range, const Character& character, std::size_t animation) {
  return range.name == "human" ? range_in_extras(range, character.animations[animation].extras_json) : range;
}

RomPaths rom_paths(const ClipToCheck& clip, const Humanoid& humanoid, const RangeOfMotion& asked) {
  const RangeOfMotion range = range_of_clip(asked, *clip.character, clip.animation);
  const Character& character = *clip.character;
  const std::vector<Pose> poses = clip_to_check(character, clip.animation).frames;
  const auto stored = frames_in_extras(character.skeleton, character.animations[clip.animation].extras_json);
  RomPaths paths = rom_paths(character.skeleton, humanoid, range, poses, stored);
  if (stored || !only_motion(character) || !clip.options.neutral_from_motion) return paths;
  paths.neutral_from_motion = true;
  HumanoidOptions options = clip.options;
  options.neutral_from_motion = false;
  Diagnostics said;
  const auto at_rest = map_humanoid(character, options, said);
  if (!at_rest) return paths;
  RomPaths rest = rom_paths(character.skeleton, *at_rest, range, poses);
  return rom_figures(rest).over_1deg_fraction < rom_figures(paths).over_1deg_fraction ? rest : paths;
}

JointRomFigures rom_figures(const JointPath& path) {
  JointRomFigures figures;
  if (path.excess_deg.empty()) return figures;
  const auto fraction_over = [&](double limit) {
    const auto over =
        std::count_if(path.excess_deg.begin(), path.excess_deg.end(), [&](double e) { return e > limit; });
    return static_cast<double>(over) / static_cast<double>(path.excess_deg.size());
  };
  figures.over_1deg_fraction = fraction_over(1.0);
  figures.over_5deg_fraction = fraction_over(5.0);
  figures.excess_max_deg = *std::max_element(path.excess_deg.begin(), path.excess_deg.end());
  return figures;
}

RomFigures rom_figures(const RomPaths& paths) {
  RomFigures figures;
  figures.rolls = paths.rolls;
  figures.neutral_from_motion = paths.neutral_from_motion;
  int moving = 0;
  for (int j = 0; j < kJointCount; ++j) {
    if (paths.joints[j].charts.empty()) continue;
    const JointRomFigures joint = rom_figures(paths.joints[j]);
    figures.joints[j] = joint;
    figures.over_1deg_fraction += joint.over_1deg_fraction;
    figures.over_5deg_fraction += joint.over_5deg_fraction;
    ++moving;
    if (joint.excess_max_deg <= figures.excess_max_deg) continue;
    figures.excess_max_deg = joint.excess_max_deg;
    figures.worst_joint = joint_at(j);
  }
  figures.over_1deg_fraction /= std::max(moving, 1);
  figures.over_5deg_fraction /= std::max(moving, 1);
  return figures;
}

Clip clip_to_check(const Character& character, std::size_t clip) {
  const Animation& animation = character.animations[clip];
  const double rate = std::clamp(native_rate(animation), 1.0, kMaxCheckedRate);
  Clip sampled = sample_clip(character.skeleton, animation, rate);
  sampled.name = clip_label(character, clip);
  return sampled;
}

}  // namespace ukemi
