#include "bake/record.h"

#include "bake/library.h"
#include "bake/response.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/file_names.h"
#include "base/or_null.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

template <typename Number>
void take(const Json& json, Number& number) {
  number = json;
}
void take(const Json& json, std::optional<double>& number) {
  if (!json.is_null()) number = json.get<double>();
}

Json to_json(const ReactionFigures& figures) {
  Json json;
  for_each_figure(figures, [&](const char* key, const auto& figure) { json[key] = or_null<Json>(figure); });
  return json;
}

ReactionFigures figures_from(const Json& json) {
  ReactionFigures figures;
  for_each_figure(figures, [&](const char* key, auto& figure) { take(json.at(key), figure); });
  return figures;
}

}  // namespace

ReactionFigures figures_of(const BakedFile& baked) {
  const BakedClip& outcome = baked.outcome;
  constexpr int pelvis = index(Segment::pelvis);
  const std::vector<BodyPose>& frames = outcome.timeline.trajectory.frames;
  const Vec3 moved = frames.back()[pelvis].translation - frames.front()[pelvis].translation;
  ReactionFigures figures;
  figures.excess_max_deg = outcome.limits.excess_max_deg;
  figures.over_1deg = outcome.limits.over_1deg;
  figures.travel_m = std::hypot(moved.x(), moved.z());
  figures.momentum_n_s = outcome.figures.momentum_n_s;
  figures.score = outcome.score;
  figures.rest_time_s = outcome.figures.rest_time_s;
  const Response response = response_of(outcome);
  figures.outcome = name(response.outcome);
  figures.end_pose = name(response.end_pose);
  figures.steps = static_cast<long>(response.steps.size());
  figures.duration_s = outcome.timeline.clip.duration_s();
  figures.joint_separation_max_m = outcome.figures.joint_separation_max_m;
  figures.energy_gain_max_j = outcome.figures.energy_gain_max_j;
  figures.frames = static_cast<long>(outcome.timeline.clip.frames.size());
  figures.keys = static_cast<long>(baked.reduced.keys);
  return figures;
}

std::string record_line(const ReactionRecord& record) {
  Json json;
  json["format"] = 1;
  json["character"] = record.character;
  json["name"] = record.name;
  json["digest"] = record.digest;
  json["figures"] = record.figures ? to_json(*record.figures) : Json(nullptr);
  json["library"] = record.library;
  json["files"] = Json::array();
  for (const WrittenFile& file : record.files)
    json["files"].push_back({{"name", file.name}, {"bytes", file.bytes}, {"sha256", file.sha256}});
  json["warnings"] = record.warnings;
  json["error"] = record.error;
  json["fix"] = record.fix;
  json["cannot_write"] = record.cannot_write;
  json["seconds"] = record.seconds;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<ReactionRecord> parse_record(std::string_view line) {
  try {
    const Json json = Json::parse(line);
    if (json.at("format") != 1) return std::nullopt;
    ReactionRecord record;
    record.character = json.at("character");
    record.name = json.at("name");
    record.digest = json.at("digest");
    if (!json.at("figures").is_null()) record.figures = figures_from(json.at("figures"));
    record.library = json.at("library");
    if (record.figures && !is_library_row(record.library)) return std::nullopt;
    for (const Json& file : json.at("files"))
      record.files.push_back({file.at("name"), file.at("bytes"), file.at("sha256")});
    for (const WrittenFile& file : record.files)
      if (!is_inside(file.name)) return std::nullopt;
    record.warnings = json.at("warnings").get<std::vector<std::string>>();
    record.error = json.at("error");
    record.fix = json.at("fix");
    record.cannot_write = json.at("cannot_write");
    record.seconds = json.at("seconds");
    return record;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace ukemi
