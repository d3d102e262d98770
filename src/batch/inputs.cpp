#include "batch/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/character_path.h"
#include "base/digest.h"
#include "base/files.h"
#include "base/uri.h"
#include "base/version.h"
#include "load/load.h"
#include "prepare/setting_table.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

/// Files beside a .gltf that its buffers and images name. A file that is not JSON names none: loading refuses
/// it.
std::vector<fs::path> files_named_by(const fs::path& gltf, std::span<const std::uint8_t> bytes) {
  std::vector<fs::path> files;
  const auto json = nlohmann::json::parse(bytes.begin(), bytes.end(), nullptr, false);
  if (!json.is_object()) return files;
  for (const char* key : {"buffers", "images"}) {
    const auto list = json.find(key);
    if (list == json.end() || !list->is_array()) continue;
    for (const auto& entry : *list) {
      const auto uri = entry.is_object() ? entry.find("uri") : entry.end();
      if (!entry.is_object() || uri == entry.end() || !uri->is_string()) continue;
      const auto text = uri->get<std::string>();
      if (!text.starts_with("data:")) files.push_back(gltf.parent_path() / percent_decoded(text));
    }
  }
  return files;
}

/// The files that the value of a setting names: itself, the file before "#NAME", or those of a folder.
std::vector<fs::path> files_of(const Setting& setting, const std::string& value) {
  std::error_code error;
  if (setting.value.find("FILE") == std::string::npos) return {};
  if (fs::is_regular_file(value, error)) return {value};
  for (std::size_t hash = value.find('#'); hash != std::string::npos; hash = value.find('#', hash + 1))
    if (fs::is_regular_file(value.substr(0, hash), error)) return {value.substr(0, hash)};
  std::vector<fs::path> files;
  if (setting.value.find("DIR") != std::string::npos && fs::is_directory(value, error))
    for (const auto& entry : fs::directory_iterator(value, error))
      if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

void add_numbers(Digest& digest, const RangeOfMotion& range) {
  const auto add = [&digest](auto... numbers) { (digest.add(fmt::format("{} ", numbers)), ...); };
  for (const JointRange& joint : range.joints) {
    const Quat &a = joint.frame.parent_from_joint, &b = joint.frame.reference;
    add(a.x(), a.y(), a.z(), a.w(), b.x(), b.y(), b.z(), b.w(), joint.twist_min, joint.twist_max);
    for (const Vec2& corner : joint.polygon) add(corner.x(), corner.y());
    digest.add("\n");
  }
}

}  // namespace

Result<std::string> InputDigests::of_file(const fs::path& file) {
  if (const auto known = files_.find(file.string()); known != files_.end()) return known->second;
  const auto bytes = read_file(file, LoadOptions{}.max_file_bytes);
  if (!bytes) return bytes.error();
  Digest digest;
  digest.add(*bytes);
  if (file.extension() == ".gltf")
    for (const fs::path& named : files_named_by(file, *bytes))
      if (const auto part = read_file(named, LoadOptions{}.max_file_bytes)) digest.add(*part);
  return files_[file.string()] = digest.hex();
}

Result<std::string> InputDigests::of_region(const std::string& region) {
  if (const auto known = regions_.find(region); known != regions_.end()) return known->second;
  const auto range = load_range_of_motion(region);
  if (!range) return range.error();
  Digest digest;
  add_numbers(digest, *range);
  return regions_[region] = digest.hex();
}

Result<std::string> InputDigests::of_program() {
  if (!program_.empty()) return program_;
  Digest digest;
  digest.add_field(generator());
  for (const char* name : {"impacts/presets.toml", "limits/active.toml"}) {
    const auto path = find_asset(name);
    if (!path) return path.error();
    const auto file = of_file(*path);
    if (!file) return file.error();
    digest.add_field(*file);
  }
  return program_ = digest.hex();
}

Result<std::string> InputDigests::of(const Reaction& reaction) {
  const auto character = character_path(recipe_.characters[reaction.character].file);
  if (!character) return character.error();
  Digest digest;
  for (const auto& part : {of_program(), of_file(*character), of_region(reaction.settings.region)}) {
    if (!part) return part.error();
    digest.add_field(*part);
  }
  if (reaction.settings.range) add_numbers(digest, *reaction.settings.range);
  for (const Setting& setting : bake_settings()) {
    digest.add_field(setting.name);
    for (const std::string& value : setting.get(reaction.settings)) {
      const std::vector<fs::path> files = files_of(setting, value);
      const bool is_file = files.size() == 1 && files.front() == value;
      if (!is_file) digest.add_field(value);
      for (const fs::path& file : files) {
        const auto part = of_file(file);
        if (!part) return part.error();
        digest.add_field(*part);
      }
    }
  }
  digest.add_field(reaction.name);
  for (const fs::path& output : reaction.settings.outputs) digest.add_field(output.extension().string());
  digest.add_field(reaction.settings.sheet.empty() ? "" : "sheet");
  digest.add_field(reaction.settings.report.empty() ? "" : "report");
  digest.add_field(reaction.settings.events.empty() ? "" : "events");
  return digest.hex();
}

}  // namespace ukemi
