#include "check/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/animation.h"
#include "base/character_path.h"
#include "base/native_rate.h"
#include "clip/names.h"
#include "load/load.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

std::vector<ClipInspection> clips_of(const Character& character) {
  std::vector<ClipInspection> clips;
  for (std::size_t i = 0; i < character.animations.size(); ++i) {
    const Animation& animation = character.animations[i];
    ClipInspection clip{clip_label(character, i), animation.duration_s(), 1, native_rate(animation), {}};
    clip.frames = 1 + std::lround(clip.duration_s * clip.fps);
    clips.push_back(std::move(clip));
  }
  return clips;
}

void check_poses(Inspection& inspection, const InspectSettings& settings, const RangeOfMotion& range) {
  const Character& character = *inspection.character;
  const Skeleton& skeleton = character.skeleton;
  const Humanoid& humanoid = *inspection.humanoid;
  inspection.rest = rom_figures(rom_paths(skeleton, humanoid, range, {rest_pose(skeleton)}));
  for (std::size_t i = 0; i < character.animations.size(); ++i) {
    const ClipToCheck clip{&character, i, settings.humanoid};
    inspection.clips[i].rom = rom_figures(rom_paths(clip, humanoid, range));
  }
}

Json rom_json(const std::optional<RomFigures>& rom) {
  if (!rom) return nullptr;
  Json joints = Json::object();
  for (int j = 0; j < kJointCount; ++j)
    if (const auto& figures = rom->joints[j])
      joints[std::string(name(joint_at(j)))] = {{"over_1deg_fraction", figures->over_1deg_fraction},
                                                {"over_5deg_fraction", figures->over_5deg_fraction},
                                                {"excess_max_deg", figures->excess_max_deg}};
  return {{"over_1deg_fraction", rom->over_1deg_fraction},
          {"over_5deg_fraction", rom->over_5deg_fraction},
          {"excess_max_deg", rom->excess_max_deg},
          {"worst_joint", rom->worst_joint ? Json(name(*rom->worst_joint)) : Json(nullptr)},
          {"rolls", name(rom->rolls)},
          {"neutral", rom->neutral_from_motion ? "motion" : "rest"},
          {"joints", std::move(joints)}};
}

void add_humanoid(Json& json, const Inspection& inspection) {
  const std::optional<Humanoid>& humanoid = inspection.humanoid;
  json["height_m"] = humanoid ? Json(humanoid->height_m) : Json(nullptr);
  json["unit_scale"] = humanoid ? Json(humanoid->world_from_file.scale) : Json(nullptr);
  json["up_axis"] = humanoid ? Json(std::string(1, humanoid->up_axis)) : Json(nullptr);
  json["rest_pose"] = humanoid ? Json(name(humanoid->rest_pose)) : Json(nullptr);
  Json map = Json::object();
  Json map_by = Json::object();
  for (int i = 0; humanoid && i < kSegmentCount; ++i) {
    const SegmentNodes& nodes = humanoid->segments[i];
    const std::string segment(name(segment_at(i)));
    map[segment] = nodes.fused() ? Json(nullptr) : Json(inspection.character->skeleton.label(nodes.node()));
    map_by[segment] = nodes.fused() ? Json(nullptr) : Json(nodes.by);
  }
  json["map"] = std::move(map);
  json["map_by"] = std::move(map_by);
}

std::string rom_text(const RomFigures& rom) {
  if (rom.excess_max_deg <= 0.0) return "inside the range of motion";
  return fmt::format("{:.2f} % over 1 degree outside, {:.2f} % over 5, at most {:.1f} ({})",
                     100.0 * rom.over_1deg_fraction, 100.0 * rom.over_5deg_fraction, rom.excess_max_deg,
                     rom.worst_joint ? name(*rom.worst_joint) : "-");
}

std::string chain_text(const Skeleton& skeleton, const SegmentNodes& nodes) {
  std::string text;
  for (const int node : nodes.chain) text += (text.empty() ? "" : " > ") + skeleton.label(node);
  return text;
}

std::string humanoid_text(const Skeleton& skeleton, const Humanoid& humanoid) {
  std::string text = fmt::format("{:.2f} m tall, {:.6g} m per unit, {} up, rest pose {}\n", humanoid.height_m,
                                 humanoid.world_from_file.scale, humanoid.up_axis, name(humanoid.rest_pose));
  for (int i = 0; i < kSegmentCount; ++i) {
    const SegmentNodes& nodes = humanoid.segments[i];
    if (nodes.fused())
      text += fmt::format("  {:<11} none: moves with the {}\n", name(segment_at(i)),
                          name(parent_of(segment_at(i))));
    else
      text +=
          fmt::format("  {:<11} {} (by {})\n", name(segment_at(i)), chain_text(skeleton, nodes), nodes.by);
  }
  return text;
}

}  // namespace

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::humanoid:
      return "humanoid";
    case Verdict::not_humanoid:
      return "not-humanoid";
    case Verdict::malformed:
      break;
  }
  return "malformed";
}

int exit_status(Verdict verdict) { return static_cast<int>(verdict); }

Result<Inspection> inspect(const std::string& file, const InspectSettings& settings,
                           Diagnostics& diagnostics) {
  const auto range = load_range_of_motion(settings.region);
  if (!range) return range.error();
  const auto path = character_path(file);
  if (!path) return path.error();
  Inspection inspection;
  auto character = load_character(*path, LoadOptions{}, diagnostics);
  if (!character) {
    inspection.error = character.error();
    inspection.reason = character.error().message();
    return inspection;
  }
  inspection.character = std::move(*character);
  inspection.clips = clips_of(*inspection.character);
  auto humanoid = map_humanoid(*inspection.character, settings.humanoid, diagnostics);
  if (!humanoid) {
    if (humanoid.error().kind != ErrorKind::input) return humanoid.error();
    inspection.verdict = Verdict::not_humanoid;
    inspection.error = humanoid.error();
    inspection.reason = humanoid.error().what;
    return inspection;
  }
  inspection.verdict = Verdict::humanoid;
  inspection.reason = "every segment that a humanoid needs was found";
  inspection.humanoid = std::move(*humanoid);
  check_poses(inspection, settings, *range);
  return inspection;
}

std::string inspection_json(const Inspection& inspection, const Diagnostics& diagnostics) {
  Json json;
  json["format"] = 1;
  json["verdict"] = name(inspection.verdict);
  json["reason"] = inspection.reason;
  add_humanoid(json, inspection);
  json["rest_rom"] = rom_json(inspection.rest);
  json["nodes"] = inspection.character ? Json(inspection.character->skeleton.size()) : Json(nullptr);
  json["clips"] = Json::array();
  for (const ClipInspection& clip : inspection.clips)
    json["clips"].push_back({{"name", clip.name},
                             {"duration_s", clip.duration_s},
                             {"frames", clip.frames},
                             {"fps", clip.fps},
                             {"rom", rom_json(clip.rom)}});
  json["warnings"] = Json::array();
  for (const Warning& warning : diagnostics.warnings())
    json["warnings"].push_back(warning.subject.empty() ? warning.what
                                                       : warning.subject + ": " + warning.what);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string inspection_text(const std::string& file, const Inspection& inspection) {
  std::string text = fmt::format("{}: {}\n", file, name(inspection.verdict));
  if (inspection.verdict != Verdict::humanoid) text += inspection.reason + "\n";
  if (!inspection.character) return text;
  const Character& character = *inspection.character;
  text += fmt::format("{} nodes, {} mesh parts, {} skins\n", character.skeleton.size(),
                      character.parts.size(), character.skins.size());
  if (inspection.humanoid) text += humanoid_text(character.skeleton, *inspection.humanoid);
  if (inspection.rest) text += fmt::format("rest pose: {}\n", rom_text(*inspection.rest));
  for (const ClipInspection& clip : inspection.clips)
    text += fmt::format("clip '{}': {:.3f} s, {} frames at {:.6g} fps{}\n", clip.name, clip.duration_s,
                        clip.frames, clip.fps, clip.rom ? ": " + rom_text(*clip.rom) : "");
  return text;
}

}  // namespace ukemi
