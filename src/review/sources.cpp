#include "review/sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "bake/outputs.h"
#include "bake/report_keys.h"
#include "base/digest.h"
#include "base/errors.h"
#include "base/file_names.h"
#include "base/files.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxJsonBytes = 256u << 20;
constexpr const char* kManifest = "manifest.json";
constexpr const char* kPageFolder = "review";

Result<Json> read_json(const fs::path& path) {
  const auto bytes = read_file(path, kMaxJsonBytes);
  if (!bytes) return bytes.error();
  Json json = Json::parse(*bytes, nullptr, false);
  if (!json.is_object()) return input_error(path, "is not a JSON object", "make the file again");
  return json;
}

/// The value at a path of keys, null where there is none.
Json value_at(const Json& json, std::initializer_list<const char*> keys) {
  const Json* here = &json;
  for (const char* key : keys) {
    if (!here->is_object() || !here->contains(key)) return nullptr;
    here = &here->at(key);
  }
  return *here;
}

std::string text_at(const Json& json, std::initializer_list<const char*> keys) {
  const Json value = value_at(json, keys);
  return value.is_string() ? value.get<std::string>() : "";
}

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// Copies the keys that `target` lacks or has as null.
void complete(Json& target, const Json& from) {
  for (const auto& [key, value] : from.items())
    if (!target.contains(key) || target[key].is_null()) target[key] = value;
}

Json shown_of_report(const Json& report, std::span<const ReportKey> keys) {
  Json json;
  for (const ReportKey& place : keys) json[place.shown] = value_at(report, {place.section, place.key});
  return json;
}

Json settings_of_report(const Json& report) { return shown_of_report(report, kReportSettings); }

Json figures_of_report(const Json& report) {
  Json json = shown_of_report(report, kReportFigures);
  json["steps"] = json["steps"].is_array() ? Json(json["steps"].size()) : Json(nullptr);
  json["settled"] = report.contains("simulation") ? Json(!json["rest_time_s"].is_null()) : Json(nullptr);
  return json;
}

/// Nothing for what lies elsewhere: a manifest cannot make the page show other places of the disk.
fs::path path_at(const Json& entry, const char* key, const fs::path& folder) {
  const fs::path path = text_at(entry, {key});
  std::error_code error;
  return is_inside(path) && fs::is_regular_file(folder / path, error) ? path : fs::path();
}

std::vector<std::string> texts_at(const Json& json, const char* key) {
  std::vector<std::string> texts;
  for (const Json& text : value_at(json, {key}))
    if (text.is_string()) texts.push_back(text.get<std::string>());
  return texts;
}

void add_report(ReviewSource& source, const fs::path& folder, Diagnostics& diagnostics) {
  Json settings = Json::parse(source.settings_json);
  Json figures = Json::parse(source.figures_json);
  if (!source.report.empty()) {
    const auto report = read_json(folder / source.report);
    if (report) {
      complete(settings, settings_of_report(*report));
      complete(figures, figures_of_report(*report));
      if (source.warnings.empty()) source.warnings = texts_at(*report, "warnings");
    } else {
      diagnostics.warn(source.report.string(), report.error().what);
      source.report.clear();
    }
  }
  source.settings_json = dumped(settings);
  source.figures_json = dumped(figures);
}

std::string object_text(const Json& entry, const char* key) {
  const Json value = value_at(entry, {key});
  return value.is_object() ? dumped(value) : "{}";
}

ReviewSource source_of_entry(const Json& entry, const fs::path& folder, Diagnostics& diagnostics) {
  ReviewSource source;
  source.character = text_at(entry, {"character"});
  source.name = text_at(entry, {"name"});
  source.status = text_at(entry, {"status"});
  source.error = text_at(entry, {"error"});
  source.digest = text_at(entry, {"digest"});
  for (const std::string& output : texts_at(entry, "outputs"))
    if (is_inside(output)) source.outputs.push_back(output);
  source.warnings = texts_at(entry, "warnings");
  source.clip = clip_among(source.outputs);
  source.report = path_at(entry, "report", folder);
  source.sheet = path_at(entry, "sheet", folder);
  source.settings_json = object_text(entry, "settings");
  source.figures_json = object_text(entry, "figures");
  add_report(source, folder, diagnostics);
  return source;
}

Result<ReviewSources> sources_of_manifest(const fs::path& folder, Diagnostics& diagnostics) {
  const fs::path path = folder / kManifest;
  const auto manifest = read_json(path);
  if (!manifest) return manifest.error();
  const Json reactions = value_at(*manifest, {"reactions"});
  if (value_at(*manifest, {"format"}) != 1 || !reactions.is_array())
    return input_error(path, "is not the manifest of a batch (format 1)", "run ukemi batch again");
  ReviewSources sources{text_at(*manifest, {"recipe"}), {}};
  for (const Json& entry : reactions) {
    if (text_at(entry, {"name"}).empty())
      return input_error(path, "has a reaction without a name", "run ukemi batch again");
    sources.reactions.push_back(source_of_entry(entry, folder, diagnostics));
  }
  return sources;
}

/// Every regular file below the folder, relative, in the order of their names; the page's own left out.
Result<std::vector<fs::path>> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator walk(folder, error), end;
  for (; !error && walk != end; walk.increment(error)) {
    const fs::path relative = walk->path().lexically_relative(folder);
    const std::string first = relative.begin()->string();
    if (first == kPageFolder || relative.filename().string().starts_with('.')) {
      if (walk->is_directory()) walk.disable_recursion_pending();
      continue;
    }
    if (walk->is_regular_file()) files.push_back(relative);
  }
  if (error) return input_error(folder, "cannot read: " + error.message(), "check the folder's permissions");
  std::sort(files.begin(), files.end());
  return files;
}

/// The report `FILE.json` beside a clip, when it is one.
std::optional<Json> report_beside(const fs::path& folder, const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(folder / path, error)) return std::nullopt;
  const auto json = read_json(folder / path);
  if (!json || value_at(*json, {"format"}) != 1 || value_at(*json, {"reaction"}).is_null())
    return std::nullopt;
  return *json;
}

/// Its own name, also of "." and "hits/".
std::string name_of_folder(const fs::path& folder) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(folder, error);
  return (error ? folder : whole).filename().string();
}

ReviewSource source_of_files(const fs::path& folder, const fs::path& stem,
                             const std::vector<std::string>& outputs, Diagnostics& diagnostics) {
  ReviewSource source;
  source.name = stem.generic_string();
  source.outputs = outputs;
  source.clip = clip_among(outputs);
  const fs::path parent = stem.parent_path();
  source.character = parent.empty() ? name_of_folder(folder) : parent.filename().string();
  if (const auto report = report_beside(folder, stem.string() + ".json")) {
    source.report = stem.string() + ".json";
    source.character = fs::path(text_at(*report, {"character"})).stem().string();
    add_report(source, folder, diagnostics);
  }
  std::error_code error;
  if (fs::is_regular_file(folder / (stem.string() + ".png"), error)) source.sheet = stem.string() + ".png";
  return source;
}

/// Names without their folders where no two reactions of a character share one.
void shorten_names(std::vector<ReviewSource>& reactions) {
  const auto short_name = [](const ReviewSource& source) {
    return fs::path(source.name).filename().string();
  };
  std::map<std::pair<std::string, std::string>, int> count;
  for (const ReviewSource& source : reactions) ++count[{source.character, short_name(source)}];
  for (ReviewSource& source : reactions)
    if (count[{source.character, short_name(source)}] == 1) source.name = short_name(source);
}

Result<ReviewSources> sources_of_folder(const fs::path& folder, Diagnostics& diagnostics) {
  const auto files = files_below(folder);
  if (!files) return files.error();
  std::map<fs::path, std::vector<std::string>> outputs;  // by path without extension
  for (const fs::path& file : *files)
    if (output_format(file)) outputs[fs::path(file).replace_extension()].push_back(file.generic_string());
  ReviewSources sources;
  for (const auto& [stem, names] : outputs)
    sources.reactions.push_back(source_of_files(folder, stem, names, diagnostics));
  shorten_names(sources.reactions);
  if (sources.reactions.empty())
    return input_error(folder, "holds no manifest.json and no .glb, .gltf or .bvh",
                       "name the folder that ukemi batch or ukemi bake wrote to");
  return sources;
}

}  // namespace

fs::path clip_among(const std::vector<std::string>& outputs) {
  for (const OutputFormat wanted : {OutputFormat::glb, OutputFormat::gltf, OutputFormat::bvh})
    for (const std::string& output : outputs)
      if (output_format(output) == wanted) return output;
  return {};
}

Result<ReviewSources> review_sources(const fs::path& folder, Diagnostics& diagnostics) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    return input_error(folder, fs::exists(folder, error) ? "is not a folder" : "there is no such folder",
                       "name the folder that ukemi batch or ukemi bake wrote to");
  if (fs::exists(folder / kManifest, error)) return sources_of_manifest(folder, diagnostics);
  return sources_of_folder(folder, diagnostics);
}

std::string manifest_digest(const fs::path& folder) {
  const auto bytes = read_file(folder / kManifest, kMaxJsonBytes);
  return bytes ? digest_of(*bytes) : std::string();
}

}  // namespace ukemi
