#include "clip/frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/version.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

std::optional<Quat> quaternion_in(const Json& json) {
  if (!json.is_array() || json.size() != 4) return std::nullopt;
  for (const Json& value : json)
    if (!value.is_number()) return std::nullopt;
  const Quat q(json[3].get<double>(), json[0].get<double>(), json[1].get<double>(), json[2].get<double>());
  if (!(std::abs(q.norm() - 1.0) < 1e-3)) return std::nullopt;
  return q.normalized();
}

/// False where a segment that needs a frame has none that fits.
bool read_segment(const Skeleton& skeleton, const Json& segments, Segment segment, SegmentFrames& frames) {
  const auto found = segments.find(std::string(name(segment)));
  if (found == segments.end()) return false;
  frames.node[index(segment)] = -1;
  if (found->is_null()) return segment != Segment::pelvis;
  if (!found->is_object() || !found->contains("node") || !found->contains("segment_from_node")) return false;
  const Json& node = found->at("node");
  const auto rotation = quaternion_in(found->at("segment_from_node"));
  if (!node.is_string() || !rotation) return false;
  frames.node[index(segment)] = skeleton.find(node.get<std::string>());
  frames.segment_from_node[index(segment)] = *rotation;
  return frames.node[index(segment)] >= 0;
}

Json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json numbers(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }

/// The nodes that do not rest in a pose.
Json pose_json(const Skeleton& skeleton, const Pose& pose) {
  Json json = Json::object();
  for (int i = 0; i < skeleton.size(); ++i) {
    const LocalTransform &rest = skeleton.nodes[i].rest, &now = pose[static_cast<std::size_t>(i)];
    if (rest.translation == now.translation && rest.scale == now.scale &&
        rest.rotation.coeffs() == now.rotation.coeffs())
      continue;
    json[skeleton.label(i)] = {{"translation", numbers(now.translation)},
                               {"rotation", numbers(now.rotation)},
                               {"scale", numbers(now.scale)}};
  }
  return json;
}

Json range_json(const JointRange& range) {
  Json json;
  for (const Vec2& corner : range.polygon) json["polygon"].push_back({corner.x(), corner.y()});
  json["twist"] = {range.twist_min, range.twist_max};
  json["parent_from_joint"] = numbers(range.frame.parent_from_joint);
  json["reference"] = numbers(range.frame.reference);
  return json;
}

/// Nothing where it is not a range (see JointRange) as this program writes it.
std::optional<JointRange> range_from(const Json& json, JointRange range) try {
  constexpr std::size_t kMostCorners = 1000;
  const auto frame = quaternion_in(json.at("parent_from_joint")),
             reference = quaternion_in(json.at("reference"));
  const auto corners = json.at("polygon").get<std::vector<std::array<double, 2>>>();
  const auto twist = json.at("twist").get<std::array<double, 2>>();
  if (!frame || !reference || corners.size() < 3 || corners.size() > kMostCorners) return std::nullopt;
  range.polygon.clear();
  for (const auto& [a_y, a_z] : corners) range.polygon.emplace_back(a_y, a_z);
  range.twist_min = twist[0];
  range.twist_max = twist[1];
  range.frame = {*frame, *reference};
  const bool valid = twist[0] <= 0.0 && twist[1] >= 0.0 && polygon_area(range.polygon) > 0.0 &&
                     polygon_distance(range.polygon, Vec2::Zero()) <= 0.0;
  return valid ? std::optional(range) : std::nullopt;
} catch (const Json::exception&) {
  return std::nullopt;
}

}  // namespace

SegmentFrames segment_frames(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& pose,
                             const BodyPose& segments) {
  const auto file_from_node = world_transforms(skeleton, pose);
  SegmentFrames frames;
  for (int i = 0; i < kSegmentCount; ++i) {
    frames.node[i] = humanoid.segments[i].node();
    frames.segment_from_node[i] = Quat::Identity();
    if (frames.node[i] < 0) continue;
    const Quat world_from_node =
        humanoid.world_from_file.rotation * rotation_part(file_from_node[frames.node[i]].linear());
    frames.segment_from_node[i] = segments[i].rotation.conjugate() * world_from_node;
  }
  return frames;
}

PerSegment<Quat> rotations_of(const Skeleton& skeleton, const SegmentFrames& frames, const Pose& pose) {
  const auto world_from_node = world_transforms(skeleton, pose);
  PerSegment<Quat> rotations;
  for (int i = 0; i < kSegmentCount; ++i) {
    if (frames.node[i] < 0) {
      rotations[i] = rotations[index(parent_of(segment_at(i)))];
      continue;
    }
    rotations[i] =
        rotation_part(world_from_node[frames.node[i]].linear()) * frames.segment_from_node[i].conjugate();
  }
  return rotations;
}

SegmentFrames moved_frames(const Skeleton& skeleton, const SegmentFrames& frames, const Pose& pose,
                           const Quat& second_from_first, const std::vector<int>& nodes,
                           const Skeleton& second, const Pose& second_pose) {
  const PerSegment<Quat> rotations = rotations_of(skeleton, frames, pose);
  const std::vector<Affine> world = world_transforms(second, second_pose);
  SegmentFrames moved;
  for (int i = 0; i < kSegmentCount; ++i) {
    const auto found = std::find(nodes.begin(), nodes.end(), frames.node[i]);
    moved.node[i] = found == nodes.end() ? -1 : static_cast<int>(found - nodes.begin());
    moved.segment_from_node[i] = Quat::Identity();
    if (moved.node[i] < 0) continue;
    const Quat world_from_segment = second_from_first * rotations[i];
    moved.segment_from_node[i] = world_from_segment.conjugate() *
                                 rotation_part(world[static_cast<std::size_t>(moved.node[i])].linear());
  }
  return moved;
}

std::string animation_extras(const Skeleton& skeleton, const SegmentFrames& frames,
                             const std::vector<Mark>& marks, const ClipFacts& facts) {
  Json segments = Json::object();
  for (int i = 0; i < kSegmentCount; ++i) {
    const Quat& q = frames.segment_from_node[i];
    Json& segment = segments[std::string(name(segment_at(i)))];
    if (frames.node[i] < 0) continue;
    segment = {{"node", skeleton.label(frames.node[i])}, {"segment_from_node", {q.x(), q.y(), q.z(), q.w()}}};
  }
  Json ours = {{"format", 1}, {"generator", generator()}};
  ours["segments"] = std::move(segments);
  for (const Mark& mark : marks) ours["marks"].push_back({{"name", mark.name}, {"time_s", mark.time_s}});
  ours["root_motion"] = facts.root_motion;
  ours["additive"] = facts.additive_from.has_value();
  if (facts.additive_from) ours["from"] = pose_json(skeleton, *facts.additive_from);
  if (facts.on_rest) ours["on_rest"] = true;
  for (const auto& [joint, range] : facts.ranges)
    ours["ranges"][std::string(name(joint))] = range_json(range);
  const Json json = {{"ukemi", std::move(ours)}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<SegmentFrames> frames_in_extras(const Skeleton& skeleton, std::string_view extras_json) {
  if (extras_json.empty()) return std::nullopt;
  const Json json = Json::parse(extras_json, nullptr, false);
  if (!json.is_object() || !json.contains("ukemi")) return std::nullopt;
  const Json& ours = json["ukemi"];
  if (!ours.is_object() || !ours.contains("segments") || !ours["segments"].is_object()) return std::nullopt;
  SegmentFrames frames;
  for (int i = 0; i < kSegmentCount; ++i)
    if (!read_segment(skeleton, ours["segments"], segment_at(i), frames)) return std::nullopt;
  return frames;
}

RangeOfMotion range_in_extras(RangeOfMotion human, std::string_view extras_json) {
  const Json json = Json::parse(extras_json, nullptr, false);
  const Json::json_pointer place("/ukemi/ranges");
  if (!json.is_object() || !json.contains(place) || !json[place].is_object()) return human;
  for (const auto& [label, range] : json[place].items()) {
    const auto joint = joint_named(label);
    if (!joint) continue;
    JointRange& in_force = human.joints[index(*joint)];
    if (const auto stored = range_from(range, in_force)) in_force = *stored;
  }
  return human;
}

std::vector<Mark> marks_in_extras(std::string_view extras_json) {
  const Json json = Json::parse(extras_json, nullptr, false);
  const Json::json_pointer place("/ukemi/marks");
  if (!json.is_object() || !json.contains(place) || !json[place].is_array()) return {};
  std::vector<Mark> marks;
  for (const Json& mark : json[place]) {
    if (!mark.is_object() || !mark.contains("name") || !mark.contains("time_s")) return {};
    if (!mark["name"].is_string() || !mark["time_s"].is_number()) return {};
    marks.push_back({mark["name"].get<std::string>(), mark["time_s"].get<double>()});
  }
  return marks;
}

}  // namespace ukemi
