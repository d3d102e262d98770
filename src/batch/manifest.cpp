#include "batch/manifest.h"
#include "base/csv.h"
#include "base/or_null.h"
#include "base/version.h"
#include "prepare/impact.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace ukemi {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

/// A setting as the recipe has it.
std::optional<std::string> written(const Reaction& reaction, const std::string& setting) {
  const auto value = reaction.written.find(setting);
  return value == reaction.written.end() ? std::nullopt : std::optional(value->second);
}

Json path_or_null(const fs::path& path, bool made) {
  return made && !path.empty() ? Json(path.generic_string()) : Json(nullptr);
}

/// What the jitter made of the settings.
Json varied_json(const Reaction& reaction) {
  if (!reaction.varies) return nullptr;
  const BakeSettings& settings = reaction.settings;
  return {{"from", settings.from.text},
          {"strength", settings.strength},
          {"aim_up_m", settings.aim_up_m},
          {"aim_left_m", settings.aim_left_m}};
}

Json settings_json(const Reaction& reaction) {
  const BakeSettings& settings = reaction.settings;
  Json json;
  json["hit"] = name(settings.hit);
  json["from"] = or_null<Json>(written(reaction, "from"));
  json["preset"] = settings.preset;
  json["scene"] = settings.scene ? Json(name(*settings.scene)) : Json(nullptr);
  json["pose"] = or_null<Json>(settings.pose);
  json["clip"] = or_null<Json>(settings.clip);
  json["at_s"] = or_null<Json>(settings.at_s);
  json["variation"] = reaction.variation;
  json["seed"] = reaction.seed;
  json["varied"] = varied_json(reaction);
  return json;
}

Json figures_json(const ReactionFigures& figures) {
  Json json;
  for_each_figure(figures, [&](std::string_view key, const auto& figure) {
    json[std::string(key)] = or_null<Json>(figure);
    if (key == "rest_time_s") json["settled"] = figures.rest_time_s.has_value();
  });
  return json;
}

Json entry_json(const Recipe& recipe, const ManifestEntry& entry) {
  const Reaction& reaction = *entry.reaction;
  const bool made = entry.record && entry.record->done();
  Json json;
  json["name"] = reaction.name;
  json["character"] = recipe.characters[reaction.character].name;
  json["status"] = name(entry.status);
  json["outputs"] = Json::array();
  for (const fs::path& output : reaction.settings.outputs)
    if (made) json["outputs"].push_back(output.generic_string());
  json["report"] = path_or_null(reaction.settings.report, made);
  json["sheet"] = path_or_null(reaction.settings.sheet, made);
  json["events"] = path_or_null(reaction.settings.events, made);
  json["settings"] = settings_json(reaction);
  json["figures"] = made ? figures_json(*entry.record->figures) : Json(nullptr);
  json["warnings"] = made ? Json(entry.record->warnings) : Json(Json::array());
  json["error"] = text_or_null<Json>(entry.error);
  json["digest"] = entry.digest;
  return json;
}

std::string csv_field(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return csv_text(value.get<std::string>());
  if (value.is_array()) {
    std::vector<std::string> parts;
    for (const Json& part : value) parts.push_back(part.get<std::string>());
    return csv_text(fmt::format("{}", fmt::join(parts, ";")));
  }
  return value.dump();
}

const std::vector<std::string> kOwn = {"character", "name", "status"};
const std::vector<std::string> kSettings = {"hit",  "from", "preset",    "scene", "pose",
                                            "clip", "at_s", "variation", "seed"};
const std::vector<std::string> kVaried = {"from", "strength", "aim_up_m", "aim_left_m"};
const std::vector<std::string> kRest = {"error", "warnings", "outputs", "report",
                                        "sheet", "events",   "digest"};

std::vector<std::string> figure_keys() {
  const Json figures = figures_json({});
  std::vector<std::string> keys;
  for (const auto& [key, value] : figures.items()) keys.push_back(key);
  return keys;
}

void add_fields(const Json& object, const std::vector<std::string>& keys, std::vector<std::string>& fields) {
  for (const std::string& key : keys)
    fields.push_back(object.is_object() ? csv_field(object.at(key)) : std::string());
}

}  // namespace

std::string_view name(ReactionStatus status) {
  switch (status) {
    case ReactionStatus::done:
      return "done";
    case ReactionStatus::failed:
      return "failed";
    case ReactionStatus::rejected:
      break;
  }
  return "rejected";
}

std::string manifest_json(const Manifest& manifest) {
  Json json;
  json["format"] = 1;
  json["generator"] = generator();
  json["recipe"] = fs::path(manifest.recipe->file).filename().string();
  json["planned"] = manifest.planned;
  json["complete"] = manifest.entries.size() == manifest.planned;
  json["reactions"] = Json::array();
  for (const ManifestEntry& entry : manifest.entries)
    json["reactions"].push_back(entry_json(*manifest.recipe, entry));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string manifest_csv(const Manifest& manifest) {
  const std::vector<std::string> figures = figure_keys();
  std::vector<std::string> header = kOwn;
  header.insert(header.end(), kSettings.begin(), kSettings.end());
  for (const std::string& key : kVaried) header.push_back("varied_" + key);
  header.insert(header.end(), figures.begin(), figures.end());
  header.insert(header.end(), kRest.begin(), kRest.end());
  std::string text = fmt::format("{}\r\n", fmt::join(header, ","));
  for (const ManifestEntry& entry : manifest.entries) {
    const Json json = entry_json(*manifest.recipe, entry);
    std::vector<std::string> fields;
    add_fields(json, kOwn, fields);
    add_fields(json["settings"], kSettings, fields);
    add_fields(json["settings"]["varied"], kVaried, fields);
    add_fields(json["figures"], figures, fields);
    add_fields(json, kRest, fields);
    text += fmt::format("{}\r\n", fmt::join(fields, ","));
  }
  return text;
}

}  // namespace ukemi
