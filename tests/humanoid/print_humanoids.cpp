// Prints what is found in files: bones, unit, up axis, height, rest pose, and how far the standing poses and
// the motion lie outside the range of motion. For reading; `print_humanoids FILE...`, `--rom` adds the
// motion.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "humanoid/humanoid.h"
#include "load/load.h"
#include "restrict/range_of_motion.h"

namespace ukemi {
namespace {

PerSegment<Quat> rotations_of(const BodyPose& body) {
  PerSegment<Quat> rotations;
  for (int s = 0; s < kSegmentCount; ++s) rotations[s] = body[s].rotation;
  return rotations;
}

/// Distance inside the range, degrees; negative outside.
double margin_deg(const JointRange& range, const SwingTwist& chart) {
  const double twist = std::min(chart.twist - range.twist_min, range.twist_max - chart.twist);
  return degrees(std::min(-polygon_distance(range.polygon, chart.swing), twist));
}

void print_map(const Character& character, const Humanoid& humanoid) {
  for (int s = 0; s < kSegmentCount; ++s) {
    const SegmentNodes& segment = humanoid.segments[s];
    std::string chain;
    for (const int node : segment.chain)
      chain += (chain.empty() ? "" : " > ") + character.skeleton.label(node);
    fmt::print("  {:11} {:10} {}{}\n", name(segment_at(s)), segment.by, chain.empty() ? "(fused)" : chain,
               segment.detached ? "  detached" : "");
  }
  const auto label = [&](int node) { return node < 0 ? std::string("-") : character.skeleton.label(node); };
  fmt::print("  root {}, toes {} {}, fingers {} {}, head top {}\n", label(humanoid.root),
             label(humanoid.toes[0]), label(humanoid.toes[1]), label(humanoid.middle_finger[0]),
             label(humanoid.middle_finger[1]), label(humanoid.head_top));
}

void print_stances(const Character& character, const Humanoid& humanoid, const RangeOfMotion& range) {
  for (const auto& [word, kind] :
       {std::pair("rest", StartPose::rest), {"stand", StartPose::stand}, {"guard", StartPose::guard}}) {
    const Pose pose = start_pose(character, humanoid, kind);
    const BodyPose body = canonical_segments_of(character.skeleton, humanoid, pose);
    const PerJoint<SwingTwist> chart = charts_of(range, rotations_of(body));
    fmt::print("  {:5}", word);
    for (int j = 0; j < kJointCount; ++j) {
      const double margin = margin_deg(range.joints[j], chart[j]);
      if (margin < 3.0)
        fmt::print(" {} {:.1f} ({:.0f} {:.0f} {:.0f})", name(joint_at(j)), margin,
                   degrees(chart[j].swing.x()), degrees(chart[j].swing.y()), degrees(chart[j].twist));
    }
    fmt::print("  pelvis {:.3f} ankles {:.3f} {:.3f}\n", body[0].translation.y(),
               body[index(Segment::foot_l)].translation.y(), body[index(Segment::foot_r)].translation.y());
  }
}

struct Count {
  int frames = 0, outside = 0, broken = 0, outside_whole = 0;
  double percent() const { return 100.0 * outside / std::max(1, frames); }
  double percent_whole() const { return 100.0 * outside_whole / std::max(1, frames - broken); }
  void add(const Count& other) {
    frames += other.frames, outside += other.outside;
    broken += other.broken, outside_whole += other.outside_whole;
  }
};

/// Captured data that no body does, whatever its range: hands and feet folded past 95 degrees, forearms
/// turned past 120.
bool is_broken(const PerSegment<Quat>& rotations, Joint joint, const SwingTwist& chart) {
  switch (joint) {
    case Joint::wrist_l:
    case Joint::wrist_r:
    case Joint::ankle_l:
    case Joint::ankle_r:
      return angle_between(rotations[index(parent_of(joint))], rotations[index(child_of(joint))]) >
             radians(95);
    case Joint::elbow_l:
    case Joint::elbow_r:
      return std::abs(chart.twist) > radians(120);
    default:
      return false;
  }
}

Count print_motion(const Character& character, const Humanoid& humanoid, const RangeOfMotion& range,
                   bool canonical) {
  PerJoint<Count> counts;
  for (const Animation& animation : character.animations) {
    const Clip clip = sample_clip(character.skeleton, animation, animation.fps > 0 ? animation.fps : 30.0);
    for (const Pose& pose : clip.frames) {
      const BodyPose body = canonical ? canonical_segments_of(character.skeleton, humanoid, pose)
                                      : segments_of(character.skeleton, humanoid, pose);
      const PerSegment<Quat> rotations = rotations_of(body);
      const PerJoint<SwingTwist> chart = charts_of(range, rotations);
      for (int j = 0; j < kJointCount; ++j) {
        const int outside = excess(range.joints[j], chart[j]) > radians(5) ? 1 : 0;
        const int broken = is_broken(rotations, joint_at(j), chart[j]) ? 1 : 0;
        counts[j].add({1, outside, broken, outside * (1 - broken)});
      }
    }
  }
  Count all;
  for (const Count& count : counts) all.add(count);
  fmt::print("  {} {:.2f} % of {}, without broken ones {:.2f} %:", canonical ? "canonical" : "raw",
             all.percent(), all.frames, all.percent_whole());
  for (int j = 0; j < kJointCount; ++j)
    if (counts[j].outside * 200 > counts[j].frames)
      fmt::print(" {} {:.0f}", name(joint_at(j)), counts[j].percent());
  fmt::print("\n");
  return all;
}

void print_file(const char* path, const RangeOfMotion& range, bool motion, std::array<Count, 2>& total) {
  Diagnostics diagnostics;
  const auto character = load_character(path, {}, diagnostics);
  if (!character) {
    fmt::print("== {}: NOT LOADED {}\n", path, character.error().message());
    return;
  }
  const auto humanoid = map_humanoid(*character, {}, diagnostics);
  if (!humanoid) {
    fmt::print("== {}: REFUSED {}\n", path, humanoid.error().what);
    return;
  }
  fmt::print("== {}: height {:.3f} m, 1 unit = {:.6g} m, up {}, rest {}\n", path, humanoid->height_m,
             humanoid->world_from_file.scale, humanoid->up_axis, name(humanoid->rest_pose));
  print_map(*character, *humanoid);
  print_stances(*character, *humanoid, range);
  for (const Warning& warning : diagnostics.warnings()) fmt::print("  warning: {}\n", warning.what);
  if (!motion) return;
  for (const bool canonical : {false, true})
    total[canonical].add(print_motion(*character, *humanoid, range, canonical));
}

}  // namespace
}  // namespace ukemi

int main(int count, char** arguments) {
  const auto range = ukemi::load_range_of_motion("human");
  if (!range) {
    fmt::print("{}\n", range.error().message());
    return 2;
  }
  bool motion = false;
  std::array<ukemi::Count, 2> total;
  for (int i = 1; i < count; ++i) {
    if (std::string_view(arguments[i]) == "--rom")
      motion = true;
    else
      ukemi::print_file(arguments[i], *range, motion, total);
  }
  for (const bool canonical : {false, true})
    if (motion)
      fmt::print("total {} {:.3f} % of {}, without {} broken ones {:.3f} %\n",
                 canonical ? "canonical" : "raw", total[canonical].percent(), total[canonical].frames,
                 total[canonical].broken, total[canonical].percent_whole());
}
