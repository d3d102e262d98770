#include "review/clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/files.h"
#include "clip/frames.h"
#include "clip/start.h"
#include "judge/rom_figures.h"
#include "load/load.h"
#include "review/json.h"
#include "review/mesh.h"
#include "review/thumbnail.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxReportBytes = 64u << 20;
constexpr double kLeafShare = 0.4;         // of the way from the parent's joint
constexpr double kSurfaceShare = 0.075;    // of the height: from a segment's middle to its skin
const double kStartMargin = radians(3.0);  // as a bake widens its ranges

/// What a bake's report tells that its clip does not.
struct Told {
  std::optional<std::string> clip;  // name
  std::map<std::string, std::string> map;
  std::optional<double> height_m, floor_m;
  std::string region = "human";
  std::vector<Joint> widened;
  std::optional<Segment> hit;
  std::optional<Vec3> direction;  // the blow's, world
  std::vector<Mark> marks;
};

void read_humanoid(const Json& humanoid, Told& told) {
  if (humanoid.contains("height_m") && humanoid["height_m"].is_number()) told.height_m = humanoid["height_m"];
  if (!humanoid.contains("map") || !humanoid["map"].is_object()) return;
  for (const auto& [segment, node] : humanoid["map"].items())
    if (node.is_string()) told.map[segment] = node.get<std::string>();
}

void read_impact(const Json& impact, Told& told) {
  const auto number = [&](const char* key) -> std::optional<double> {
    if (!impact.contains(key) || !impact[key].is_number()) return std::nullopt;
    return impact[key].get<double>();
  };
  told.floor_m = number("floor_height_m");
  if (impact.contains("segment") && impact["segment"].is_string())
    told.hit = segment_named(impact["segment"].get<std::string>());
  if (impact.contains("direction") && impact["direction"].is_array() && impact["direction"].size() == 3 &&
      std::all_of(impact["direction"].begin(), impact["direction"].end(),
                  [](const Json& v) { return v.is_number(); }))
    told.direction = Vec3(impact["direction"][0], impact["direction"][1], impact["direction"][2]);
  if (const auto time = number("time_s")) told.marks.push_back({"impact", *time});
  if (const auto time = number("first_ground_contact_s"))
    told.marks.push_back({"first ground contact", *time});
}

Told told_by(const fs::path& folder, const fs::path& report) {
  Told told;
  if (report.empty()) return told;
  const auto bytes = read_file(folder / report, kMaxReportBytes);
  const Json json = bytes ? Json::parse(*bytes, nullptr, false) : Json();
  if (!json.is_object()) return told;
  const auto part = [&](const char* key) {
    return json.contains(key) && json[key].is_object() ? json[key] : Json::object();
  };
  if (const Json clip = part("clip"); clip.contains("name") && clip["name"].is_string())
    told.clip = clip["name"].get<std::string>();
  if (const Json settings = part("settings"); settings.contains("region") && settings["region"].is_string())
    told.region = settings["region"].get<std::string>();
  read_humanoid(part("humanoid"), told);
  read_impact(part("impact"), told);
  const Json limits = part("limits");
  if (limits.contains("widened_deg") && limits["widened_deg"].is_object())
    for (const auto& [name, angle] : limits["widened_deg"].items())
      if (const auto joint = joint_named(name)) told.widened.push_back(*joint);
  if (const Json simulation = part("simulation");
      simulation.contains("rest_time_s") && simulation["rest_time_s"].is_number())
    told.marks.push_back({"rest", simulation["rest_time_s"]});
  return told;
}

/// With the nodes and the height that the bake used, where the file has them still.
Result<Humanoid> humanoid_of(const Character& character, const Told& told, Diagnostics& diagnostics) {
  HumanoidOptions options;
  options.map = told.map;
  if (!character.parts.empty()) options.height_m = told.height_m;
  Diagnostics quiet;
  auto humanoid = map_humanoid(character, options, quiet);
  if (humanoid) return humanoid;
  return map_humanoid(character, HumanoidOptions{}, diagnostics);
}

Result<std::size_t> clip_index(const Character& character, const Told& told) {
  if (character.animations.empty())
    return input_error(character.path, "holds no clip", "bake it, or remove it from the folder");
  if (told.clip) {
    for (std::size_t i = character.animations.size(); i-- > 0;)
      if (character.animations[i].name == *told.clip) return i;
  }
  return character.animations.size() - 1;
}

RangeOfMotion range_of(const Told& told, const std::string& file, Diagnostics& diagnostics) {
  auto range = load_range_of_motion(told.region);
  if (range) return *range;
  diagnostics.warn(
      file, fmt::format("the range of motion '{}' cannot be read; joints are shown in 'human'", told.region));
  return *load_range_of_motion("human");
}

// ---- the clip's keys

const char* path_name(TrackPath path) {
  switch (path) {
    case TrackPath::translation:
      return "position";
    case TrackPath::scale:
      return "scale";
    case TrackPath::rotation:
      break;
  }
  return "quaternion";
}

/// Keys with linear interpolation: as stored, or for cubic ones at every frame of `sampled`.
Json track_json(const Track& track, const Clip& sampled, double start_s) {
  std::vector<float> times, values;
  if (track.interpolation != Interpolation::cubic) {
    for (const double time : track.times) times.push_back(static_cast<float>(time - start_s));
    for (const double value : track.values) values.push_back(static_cast<float>(value));
  } else {
    for (std::size_t f = 0; f < sampled.frames.size(); ++f) {
      const LocalTransform& local = sampled.frames[f][track.node];
      times.push_back(static_cast<float>(static_cast<double>(f) / sampled.fps));
      const auto add = [&](const auto& v) {
        for (int i = 0; i < v.size(); ++i) values.push_back(static_cast<float>(v[i]));
      };
      if (track.path == TrackPath::rotation) add(local.rotation.coeffs());
      if (track.path == TrackPath::translation) add(local.translation);
      if (track.path == TrackPath::scale) add(local.scale);
    }
  }
  return {{"node", track.node},
          {"path", path_name(track.path)},
          {"step", track.interpolation == Interpolation::step},
          {"times", packed(times)},
          {"values", packed(values)}};
}

// ---- the joints' paths through their ranges

/// Signed: how far outside (positive) or inside (negative) its range a joint is, degrees.
double margin_deg(const JointRange& range, const SwingTwist& chart) {
  const double twist = std::max(chart.twist - range.twist_max, range.twist_min - chart.twist);
  return degrees(std::max(polygon_distance(range.polygon, chart.swing), twist));
}

/// Values as whole multiples of `scale`.
Json quantized(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  const double scale = largest > 0.0 ? largest / 32767.0 : 1.0;
  std::vector<std::int16_t> whole;
  for (const double value : values) whole.push_back(static_cast<std::int16_t>(std::lround(value / scale)));
  return {{"scale", scale}, {"values", packed(whole)}};
}

double rounded(double value) { return std::round(value * 1e4) / 1e4; }

/// The node that carries the segment's rotation.
Segment carrier(const SegmentFrames& frames, Segment segment) {
  while (frames.node[index(segment)] < 0 && segment != Segment::pelvis) segment = parent_of(segment);
  return segment;
}

Json joint_json(const JointRange& range, const JointPath& path, const SegmentFrames& frames,
                const Humanoid& humanoid, Joint joint) {
  const Segment parent = carrier(frames, parent_of(joint));
  const Quat node_from_joint =
      frames.segment_from_node[index(parent)].conjugate() * range.frame.parent_from_joint;
  Json json;
  json["name"] = name(joint);
  json["polygon_deg"] = Json::array();
  for (const Vec2& corner : range.polygon)
    json["polygon_deg"].push_back({rounded(degrees(corner.x())), rounded(degrees(corner.y()))});
  json["twist_deg"] = {rounded(degrees(range.twist_min)), rounded(degrees(range.twist_max))};
  json["meanings"] = Json::array();
  for (const AxisMeaning& meaning : range.meanings)
    json["meanings"].push_back({meaning.negative, meaning.positive});
  json["parent"] = frames.node[index(parent)];
  json["origin"] = humanoid.segments[index(child_of(joint))].chain.empty()
                       ? frames.node[index(child_of(joint))]
                       : humanoid.segments[index(child_of(joint))].chain.front();
  json["node_from_joint"] = {node_from_joint.x(), node_from_joint.y(), node_from_joint.z(),
                             node_from_joint.w()};
  std::vector<double> a_y, a_z, twist, margin;
  for (const SwingTwist& chart : path.charts) {
    a_y.push_back(degrees(chart.swing.x()));
    a_z.push_back(degrees(chart.swing.y()));
    twist.push_back(degrees(chart.twist));
    margin.push_back(margin_deg(range, chart));
  }
  json["a_y_deg"] = quantized(a_y);
  json["a_z_deg"] = quantized(a_z);
  json["twist_path_deg"] = quantized(twist);
  json["margin_deg"] = quantized(margin);
  return json;
}

/// The joints' paths in the ranges that the bake had, those widened for its start included.
Json rom_json(const Character& character, const Humanoid& humanoid, const Clip& sampled,
              const std::string& extras, RangeOfMotion range, const std::vector<Joint>& widened,
              double& excess_max_deg) {
  const Skeleton& skeleton = character.skeleton;
  const auto stored = frames_in_extras(skeleton, extras);
  const SegmentFrames frames =
      stored ? *stored
             : segment_frames(skeleton, humanoid, sampled.frames.front(),
                              canonical_segments_of(skeleton, humanoid, sampled.frames.front()));
  const RomPaths paths = rom_paths(skeleton, humanoid, range, sampled.frames, stored);
  Json json;
  json["region"] = range.name;
  json["rolls"] = name(paths.rolls);
  json["fps"] = sampled.fps;
  json["frames"] = sampled.frames.size();
  json["joints"] = Json::array();
  excess_max_deg = 0.0;
  for (int j = 0; j < kJointCount; ++j) {
    const JointPath& path = paths.joints[j];
    if (path.charts.empty()) continue;
    if (std::find(widened.begin(), widened.end(), joint_at(j)) != widened.end())
      widen_to_hold(range.joints[j], path.charts.front(), kStartMargin);
    for (const SwingTwist& chart : path.charts)
      excess_max_deg = std::max(excess_max_deg, degrees(excess(range.joints[j], chart)));
    json["joints"].push_back(joint_json(range.joints[j], path, frames, humanoid, joint_at(j)));
  }
  return json;
}

/// The marks that a bake wrote into the clip; else those of its report.
std::vector<Mark> marks_of(const Animation& animation, const Told& told) {
  std::vector<Mark> marks = marks_in_extras(animation.extras_json);
  if (marks.empty()) return told.marks;
  for (Mark& mark : marks) std::replace(mark.name.begin(), mark.name.end(), '_', ' ');
  return marks;
}

Json marks_json(const std::vector<Mark>& marks, double duration_s) {
  Json json = Json::array();
  for (const Mark& mark : marks)
    if (mark.time_s <= duration_s) json.push_back({{"name", mark.name}, {"time_s", mark.time_s}});
  return json;
}

/// About the middle of a segment: half way to what hangs on it, or as far on as it lies from its parent.
Vec3 middle_of(const BodyPose& body, Segment segment) {
  const Vec3& origin = body[index(segment)].translation;
  Vec3 sum = Vec3::Zero();
  int below = 0;
  for (int i = 0; i < kSegmentCount; ++i) {
    if (segment_at(i) == segment || parent_of(segment_at(i)) != segment) continue;
    sum += body[i].translation;
    ++below;
  }
  if (below > 0) return 0.5 * (origin + sum / below);
  return origin + kLeafShare * (origin - body[index(parent_of(segment))].translation);
}

/// Where the blow ends, about at the skin; meaningless where nothing is known of it.
Vec3 impact_point(const Told& told, const BodyPose& first, double height_m) {
  if (!told.hit || !told.direction) return Vec3::Zero();
  return middle_of(first, *told.hit) - kSurfaceShare * height_m * *told.direction;
}

Json impact_json(const Told& told, const Vec3& point) {
  if (!told.hit || !told.direction) return nullptr;
  const Vec3& d = *told.direction;
  return {{"point", {point.x(), point.y(), point.z()}}, {"direction", {d.x(), d.y(), d.z()}}};
}

/// Places of the hips over the ground.
double travel(const Character& character, const Humanoid& humanoid, const Clip& clip) {
  const auto hips = [&](const Pose& pose) {
    return segments_of(character.skeleton, humanoid, pose)[index(Segment::pelvis)].translation;
  };
  Vec3 way = hips(clip.frames.back()) - hips(clip.frames.front());
  way.y() = 0.0;
  return way.norm();
}

std::string dumped(const Json& json) {
  return script_safe(json.dump(-1, ' ', true, Json::error_handler_t::replace));
}

}  // namespace

Result<ReviewClip> review_clip(const fs::path& folder, const ReviewSource& source, Diagnostics& diagnostics) {
  const auto character = load_character(folder / source.clip, LoadOptions{}, diagnostics);
  if (!character) return character.error();
  const Told told = told_by(folder, source.report);
  const auto chosen = clip_index(*character, told);
  if (!chosen) return chosen.error();
  const auto humanoid = humanoid_of(*character, told, diagnostics);
  if (!humanoid) return humanoid.error();
  const Animation& animation = character->animations[*chosen];
  const Clip sampled = clip_to_check(*character, *chosen);

  ReviewClip result;
  result.duration_s = animation.duration_s();
  result.travel_m = travel(*character, *humanoid, sampled);
  Json json;
  json["clip"] = sampled.name;
  json["duration_s"] = result.duration_s;
  json["fps"] = sampled.fps;
  const double floor_m = told.floor_m ? *told.floor_m : floor_of(*character, *humanoid, sampled.frames);
  json["floor_m"] = floor_m;
  json["root"] = humanoid->root;
  json["marks"] = marks_json(marks_of(animation, told), result.duration_s);
  const BodyPose first = segments_of(character->skeleton, *humanoid, sampled.frames.front());
  const Vec3 point = impact_point(told, first, humanoid->height_m);
  const Vec3 forward = first[index(Segment::pelvis)].rotation * Vec3::UnitX();
  json["forward"] = {forward.x(), forward.y(), forward.z()};
  json["impact"] = impact_json(told, point);
  json["tracks"] = Json::array();
  for (const Track& track : animation.tracks)
    json["tracks"].push_back(track_json(track, sampled, animation.start_s));
  json["rom"] =
      rom_json(*character, *humanoid, sampled, animation.extras_json,
               range_of(told, source.clip.string(), diagnostics), told.widened, result.clip_excess_max_deg);
  result.clip_json = dumped(json);
  result.mesh = review_mesh(*character, *humanoid);
  const ReviewedClip reviewed{*character, *humanoid, sampled,
                              floor_m,    point,     told.direction.value_or(Vec3::Zero())};
  auto thumbnails = review_thumbnails(reviewed);
  if (!thumbnails) return thumbnails.error();
  result.thumbnail_light = std::move(thumbnails->light);
  result.thumbnail_dark = std::move(thumbnails->dark);
  return result;
}

}  // namespace ukemi
