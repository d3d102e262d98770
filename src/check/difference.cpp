#include "check/difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/animation.h"
#include "base/character_path.h"
#include "base/errors.h"
#include "base/native_rate.h"
#include "check/inspect.h"
#include "clip/names.h"
#include "load/load.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMostSamples = 200000.0;  // of one comparison
constexpr double kMinRate = 30.0;
constexpr double kMaxRate = 240.0;
constexpr std::size_t kWorstShown = 5;
constexpr double kSameAxes = 1e-3;    // rad
constexpr double kSameOffset = 1e-3;  // m

/// A joint that both files have.
struct Match {
  int node_a = -1;
  int node_b = -1;
  int parent = -1;  // index of the match that rotations are measured from; -1: the world
};

int nearest_matched_ancestor(const Skeleton& skeleton, int node, const std::map<int, int>& match_of_node) {
  for (int i = skeleton.nodes[node].parent; i >= 0; i = skeleton.nodes[i].parent)
    if (const auto found = match_of_node.find(i); found != match_of_node.end()) return found->second;
  return -1;
}

/// Nodes that the clip moves, and those above and below them.
std::vector<char> moved_nodes(const Skeleton& skeleton, const Animation& animation) {
  std::vector<char> has_track(skeleton.nodes.size(), 0);
  for (const Track& track : animation.tracks)
    if (track.node >= 0) has_track[static_cast<std::size_t>(track.node)] = 1;
  std::vector<char> below(has_track), above(has_track);
  for (const int node : skeleton.order)
    if (const int parent = skeleton.nodes[node].parent; parent >= 0 && below[parent]) below[node] = 1;
  for (auto it = skeleton.order.rbegin(); it != skeleton.order.rend(); ++it)
    if (const int parent = skeleton.nodes[*it].parent; parent >= 0 && above[*it]) above[parent] = 1;
  for (std::size_t i = 0; i < below.size(); ++i) below[i] = below[i] || above[i] ? 1 : 0;
  return below;
}

/// Nodes by name, without meshes. Where two figures share bone names, a name means the bone of the one that
/// moves; a node without a name of its own goes by its number.
std::map<std::string, int> joints_by_name(const Character& character, const Animation& animation) {
  const Skeleton& skeleton = character.skeleton;
  std::vector<char> is_bone(skeleton.nodes.size(), 1);
  for (const MeshPart& part : character.parts)
    if (part.skin >= 0 && part.node >= 0) is_bone[static_cast<std::size_t>(part.node)] = 0;
  std::map<std::string, int> nodes = nodes_by_plain_name(skeleton, is_bone);
  const std::vector<char> moved = moved_nodes(skeleton, animation);
  for (std::size_t i = 0; i < is_bone.size(); ++i) is_bone[i] = is_bone[i] && moved[i] ? 1 : 0;
  for (const auto& [name, node] : nodes_by_plain_name(skeleton, is_bone))
    if (node >= 0) nodes[name] = node;
  std::erase_if(nodes, [](const auto& named) { return named.second < 0; });
  std::vector<char> has_name(skeleton.nodes.size(), 0);
  for (const auto& [name, node] : nodes) has_name[static_cast<std::size_t>(node)] = 1;
  for (int i = 0; i < skeleton.size(); ++i)
    if (!has_name[static_cast<std::size_t>(i)]) nodes[fmt::format("#{}", i)] = i;
  return nodes;
}

std::vector<Match> match_joints(const PlacedClip& clip_a, const PlacedClip& clip_b, Difference& difference) {
  const Character &a = *clip_a.character, &b = *clip_b.character;
  std::map<std::string, int> in_b = joints_by_name(b, *clip_b.animation);
  std::vector<std::string> name_in_a(a.skeleton.nodes.size());
  for (const auto& [name, node] : joints_by_name(a, *clip_a.animation))
    name_in_a[static_cast<std::size_t>(node)] = name;
  std::vector<Match> matches;
  std::map<int, int> match_of_a;
  for (const int i : a.skeleton.order) {
    const auto found = in_b.find(name_in_a[static_cast<std::size_t>(i)]);
    if (found == in_b.end()) {
      difference.only_in_a.push_back(a.skeleton.label(i));
      continue;
    }
    match_of_a[i] = static_cast<int>(matches.size());
    matches.push_back({i, found->second, -1});
    in_b.erase(found);
  }
  for (const auto& [name, node] : in_b) difference.only_in_b.push_back(b.skeleton.label(node));
  std::map<int, int> match_of_b;
  for (std::size_t m = 0; m < matches.size(); ++m) match_of_b[matches[m].node_b] = static_cast<int>(m);
  for (Match& match : matches) {
    const int above_a = nearest_matched_ancestor(a.skeleton, match.node_a, match_of_a);
    const int above_b = nearest_matched_ancestor(b.skeleton, match.node_b, match_of_b);
    match.parent = above_a == above_b ? above_a : -1;
  }
  return matches;
}

/// World positions and rotations of a clip's nodes at a time.
struct World {
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
};

World world_of(const PlacedClip& clip, const Pose& pose) {
  World world;
  for (const Affine& file_from_node : world_transforms(clip.character->skeleton, pose)) {
    world.positions.push_back(clip.world_from_file * Vec3(file_from_node.translation()));
    world.rotations.push_back(clip.world_from_file.rotation * rotation_part(file_from_node.linear()));
  }
  return world;
}

World world_at(const PlacedClip& clip, double time_s) {
  return world_of(clip, sample(clip.character->skeleton, *clip.animation, clip.animation->start_s + time_s));
}

/// Compares two clips of the same joints.
class ClipComparison {
 public:
  ClipComparison(const PlacedClip& a, const PlacedClip& b, std::vector<Match> matches)
      : a_(a), b_(b), matches_(std::move(matches)) {
    for (const Match& match : matches_)
      joints_.push_back({a.character->skeleton.label(match.node_a), 0, 0, 0, 0});
    same_axes_ = rest_poses_agree();
    first_a_ = world_at(a_, 0.0).rotations;
    first_b_ = world_at(b_, 0.0).rotations;
  }

  bool same_axes() const { return same_axes_; }
  std::vector<JointDifference> take_joints() { return std::move(joints_); }

  void compare_at(double time_s) {
    const World a = world_at(a_, time_s);
    const World b = world_at(b_, time_s);
    for (std::size_t m = 0; m < matches_.size(); ++m) {
      JointDifference& joint = joints_[m];
      const double position_mm =
          1000.0 * (a.positions[matches_[m].node_a] - b.positions[matches_[m].node_b]).norm();
      const double rotation_deg = degrees(angle_between(local(a.rotations, first_a_, m, &Match::node_a),
                                                        local(b.rotations, first_b_, m, &Match::node_b)));
      if (position_mm > joint.position_mm) joint.position_mm = position_mm, joint.position_at_s = time_s;
      if (rotation_deg > joint.rotation_deg) joint.rotation_deg = rotation_deg, joint.rotation_at_s = time_s;
    }
  }

 private:
  /// Rotation of a joint from its matched parent: as it is, or as a change since the first frame, in world
  /// axes.
  Quat local(const std::vector<Quat>& now, const std::vector<Quat>& first, std::size_t match,
             int Match::*node) const {
    const auto turned = [&](std::size_t m) -> Quat {
      const int i = matches_[m].*node;
      return same_axes_ ? now[i] : Quat(now[i] * first[i].conjugate());
    };
    const int parent = matches_[match].parent;
    return parent < 0 ? turned(match) : Quat(turned(parent).conjugate() * turned(match));
  }

  bool rest_poses_agree() const {
    const World a = world_of(a_, rest_pose(a_.character->skeleton));
    const World b = world_of(b_, rest_pose(b_.character->skeleton));
    for (const Match& match : matches_) {
      const Rigid local_a = rest_local(a, match, &Match::node_a);
      const Rigid local_b = rest_local(b, match, &Match::node_b);
      if (angle_between(local_a.rotation, local_b.rotation) > kSameAxes) return false;
      if (match.parent >= 0 && (local_a.translation - local_b.translation).norm() > kSameOffset) return false;
    }
    return true;
  }

  Rigid rest_local(const World& world, const Match& match, int Match::*node) const {
    const Rigid own{world.rotations[match.*node], world.positions[match.*node]};
    if (match.parent < 0) return own;
    const int parent = matches_[match.parent].*node;
    return Rigid{world.rotations[parent], world.positions[parent]}.inverse() * own;
  }

  const PlacedClip& a_;
  const PlacedClip& b_;
  std::vector<Match> matches_;
  std::vector<JointDifference> joints_;
  bool same_axes_ = true;
  std::vector<Quat> first_a_, first_b_;
};

double share_of_tolerance(const JointDifference& joint, const DifferenceSettings& settings) {
  return std::max(joint.position_mm / std::max(settings.tolerance_mm, 1e-9),
                  joint.rotation_deg / std::max(settings.tolerance_deg, 1e-9));
}

/// Metres and y up: the humanoid's, or what the file states.
Similarity placement(const Character& character, Diagnostics& diagnostics) {
  Diagnostics unused;
  if (const auto humanoid = map_humanoid(character, HumanoidOptions{}, unused))
    return humanoid->world_from_file;
  if (character.format != SourceFormat::gltf && !character.metres_per_unit)
    diagnostics.warn(character.path.string(), "states no unit and is not a humanoid; taken as metres");
  Similarity similarity;
  similarity.scale = character.metres_per_unit.value_or(1.0);
  similarity.rotation = character.yup_from_file.value_or(Quat::Identity());
  return similarity;
}

Result<const Animation*> clip_to_compare(const Character& character, const DifferenceSettings& settings) {
  if (character.animations.empty())
    return input_error(character.path, "holds no clip", "name a file with a clip");
  if (!settings.clip) return &character.animations.back();
  const auto found = find_clip(character, *settings.clip);
  if (!found) return found.error();
  return &character.animations[*found];
}

Result<Character> load(const std::string& file, Diagnostics& diagnostics) {
  const auto path = character_path(file);
  if (!path) return path.error();
  return load_character(*path, LoadOptions{}, diagnostics);
}

template <typename Member>
double largest(const Difference& difference, Member member) {
  double value = 0.0;
  for (const JointDifference& joint : difference.joints) value = std::max(value, joint.*member);
  return value;
}

/// The first word of the answer: what differs.
std::string_view verdict_of(const Difference& difference, const DifferenceSettings& settings) {
  if (difference.within_tolerance) return "same";
  const bool moves_alike = largest(difference, &JointDifference::position_mm) <= settings.tolerance_mm &&
                           largest(difference, &JointDifference::rotation_deg) <= settings.tolerance_deg;
  return moves_alike ? "different lengths, the same as far as the shorter goes" : "different";
}

}  // namespace

Result<Difference> difference_of(const PlacedClip& a, const PlacedClip& b,
                                 const DifferenceSettings& settings) {
  Difference difference;
  difference.clip_a = a.animation->name;
  difference.clip_b = b.animation->name;
  difference.duration_a_s = a.animation->duration_s();
  difference.duration_b_s = b.animation->duration_s();
  std::vector<Match> matches = match_joints(a, b, difference);
  if (matches.empty())
    return input_error(b.character->path,
                       "no joint has the same name as one of " + a.character->path.string(),
                       "compare clips of the same skeleton");
  ClipComparison comparison(a, b, std::move(matches));
  difference.same_axes = comparison.same_axes();
  difference.rate =
      std::clamp(std::max(native_rate(*a.animation), native_rate(*b.animation)), kMinRate, kMaxRate);
  const double shared_s = std::min(difference.duration_a_s, difference.duration_b_s);
  difference.rate = std::min(difference.rate, kMostSamples / std::max(shared_s, 1e-3));
  const long last = std::lround(std::floor(shared_s * difference.rate + 1e-3));
  for (long i = 0; i <= last; ++i) comparison.compare_at(static_cast<double>(i) / difference.rate);
  difference.samples = last + 1;
  std::vector<JointDifference> joints = comparison.take_joints();
  std::stable_sort(joints.begin(), joints.end(), [&](const JointDifference& x, const JointDifference& y) {
    return share_of_tolerance(x, settings) > share_of_tolerance(y, settings);
  });
  difference.joints = std::move(joints);
  difference.same_duration =
      std::abs(difference.duration_a_s - difference.duration_b_s) <= 0.5 / difference.rate;
  difference.within_tolerance = difference.same_duration &&
                                largest(difference, &JointDifference::position_mm) <= settings.tolerance_mm &&
                                largest(difference, &JointDifference::rotation_deg) <= settings.tolerance_deg;
  return difference;
}

Result<Difference> difference_of_files(const std::string& a, const std::string& b,
                                       const DifferenceSettings& settings, Diagnostics& diagnostics) {
  const auto character_a = load(a, diagnostics);
  if (!character_a) return character_a.error();
  const auto character_b = load(b, diagnostics);
  if (!character_b) return character_b.error();
  const auto clip_a = clip_to_compare(*character_a, settings);
  if (!clip_a) return clip_a.error();
  const auto clip_b = clip_to_compare(*character_b, settings);
  if (!clip_b) return clip_b.error();
  return difference_of({&*character_a, *clip_a, placement(*character_a, diagnostics)},
                       {&*character_b, *clip_b, placement(*character_b, diagnostics)}, settings);
}

std::string difference_json(const std::string& a, const std::string& b, const Difference& difference,
                            const DifferenceSettings& settings) {
  Json json;
  json["format"] = 1;
  json["within_tolerance"] = difference.within_tolerance;
  json["tolerance_deg"] = settings.tolerance_deg;
  json["tolerance_mm"] = settings.tolerance_mm;
  json["a"] = a;
  json["b"] = b;
  json["clip_a"] = difference.clip_a;
  json["clip_b"] = difference.clip_b;
  json["duration_a_s"] = difference.duration_a_s;
  json["duration_b_s"] = difference.duration_b_s;
  json["samples"] = difference.samples;
  json["position_max_mm"] = largest(difference, &JointDifference::position_mm);
  json["rotation_max_deg"] = largest(difference, &JointDifference::rotation_deg);
  json["rotations"] = difference.same_axes ? "local" : "since-first-frame";
  json["joints"] = Json::array();
  for (const JointDifference& joint : difference.joints)
    json["joints"].push_back({{"joint", joint.joint},
                              {"position_mm", joint.position_mm},
                              {"position_at_s", joint.position_at_s},
                              {"rotation_deg", joint.rotation_deg},
                              {"rotation_at_s", joint.rotation_at_s}});
  json["only_in_a"] = difference.only_in_a;
  json["only_in_b"] = difference.only_in_b;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string difference_text(const std::string& a, const std::string& b, const Difference& difference,
                            const DifferenceSettings& settings) {
  std::string text = fmt::format(
      "{}: {} joints at {} times; at most {:.4g} mm and {:.4g} degrees (tolerance {:.4g} mm, {:.4g} "
      "degrees)\n",
      verdict_of(difference, settings), difference.joints.size(), difference.samples,
      largest(difference, &JointDifference::position_mm), largest(difference, &JointDifference::rotation_deg),
      settings.tolerance_mm, settings.tolerance_deg);
  if (!difference.same_duration)
    text += fmt::format("lengths differ: {:.3f} s and {:.3f} s\n", difference.duration_a_s,
                        difference.duration_b_s);
  if (!difference.same_axes)
    text += "rest poses differ: rotations are compared as changes since the first frame\n";
  for (std::size_t i = 0; i < std::min(kWorstShown, difference.joints.size()); ++i) {
    const JointDifference& joint = difference.joints[i];
    text += fmt::format("  {}: {:.4g} mm at {:.3f} s, {:.4g} degrees at {:.3f} s\n", joint.joint,
                        joint.position_mm, joint.position_at_s, joint.rotation_deg, joint.rotation_at_s);
  }
  const auto count = [&](const std::string& file, const std::vector<std::string>& names) {
    if (!names.empty()) text += fmt::format("{} joints only in {}\n", names.size(), file);
  };
  count(a, difference.only_in_a);
  count(b, difference.only_in_b);
  return text;
}

}  // namespace ukemi
