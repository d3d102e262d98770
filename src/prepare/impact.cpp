#include "prepare/impact.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/errors.h"
#include "base/files.h"
#include "base/nearest.h"
#include "base/numbers.h"
#include "body/anthropometry.h"
#include "prepare/settings.h"

namespace ukemi {
namespace {

constexpr std::int64_t kPresetFormat = 1;
const std::vector<std::string> kSceneNames = {"ball", "slope", "fall", "push", "impulse",  "box",
                                              "none", "trip",  "slip", "pull", "explosion"};

Error preset_error(const std::string& file, const toml::source_region& where, std::string what,
                   std::string fix) {
  return error_at(where.begin, input_error(file, std::move(what), std::move(fix)));
}

/// Reads the keys of one preset table; the first error stays.
class PresetReader {
 public:
  PresetReader(const std::string& file, std::string name, const toml::table& table)
      : file_(file), table_(table) {
    preset_.name = std::move(name);
  }

  Result<ImpactPreset> read() {
    preset_.mass_kg = required("mass_kg");
    preset_.speed_m_s = required("speed_m_s");
    preset_.radius_m = required("radius_m");
    preset_.push_duration_s = optional("push_duration_s").value_or(preset_.push_duration_s);
    preset_.distance_m = optional("distance_m").value_or(preset_.distance_m);
    preset_.slippery_s = optional("slippery_s").value_or(preset_.slippery_s);
    read_scene();
    read_flag("stylised", preset_.stylised);
    read_flag("spread", preset_.spread);
    refuse_unknown_keys();
    if (error_) return *error_;
    return preset_;
  }

 private:
  void fail(const toml::node& node, const std::string& what, std::string fix) {
    if (!error_)
      error_ = preset_error(file_, node.source(), fmt::format("preset '{}': {}", preset_.name, what),
                            std::move(fix));
  }

  std::optional<double> optional(std::string_view key) {
    const toml::node* node = table_.get(key);
    if (!node) return std::nullopt;
    const auto value = node->value<double>();
    if (value && std::isfinite(*value) && *value > 0.0) return value;
    fail(*node, fmt::format("'{}' is not a number above 0", key), "write a number above 0");
    return std::nullopt;
  }

  double required(std::string_view key) {
    if (!table_.get(key))
      fail(table_, fmt::format("'{}' is missing", key), fmt::format("add '{} = ...'", key));
    return optional(key).value_or(0.0);
  }

  void read_flag(const char* key, bool& flag) {
    const toml::node* node = table_.get(key);
    if (!node) return;
    if (const auto value = node->value_exact<bool>())
      flag = *value;
    else
      fail(*node, fmt::format("'{}' is not true or false", key), "write true or false");
  }

  void read_scene() {
    const toml::node* node = table_.get("scene");
    if (!node) return;
    const auto text = node->value_exact<std::string>();
    auto scene = text ? parse_scene(*text)
                      : Result<SceneKind>(usage_error("'scene' is not a word", "write scene = \"ball\""));
    if (scene)
      preset_.scene = *scene;
    else
      fail(*node, scene.error().what, scene.error().fix);
  }

  void refuse_unknown_keys() {
    static const std::vector<std::string> known = {"scene",    "mass_kg",    "speed_m_s",
                                                   "radius_m", "stylised",   "push_duration_s",
                                                   "spread",   "distance_m", "slippery_s"};
    for (auto&& [key, node] : table_) {
      const std::string text(key.str());
      if (std::find(known.begin(), known.end(), text) == known.end())
        fail(node, fmt::format("unknown key '{}'", text), suggestion(text, known));
    }
  }

  const std::string& file_;
  const toml::table& table_;
  ImpactPreset preset_;
  std::optional<Error> error_;
};

/// toml++ sorts keys; the file's order is restored.
Result<std::vector<ImpactPreset>> read_presets(const toml::table& document, const std::string& file) {
  if (document["format"].value_exact<std::int64_t>() != kPresetFormat)
    return preset_error(file, document.source(), "'format' is not 1", "write format = 1 at the top");
  std::vector<std::pair<toml::source_position, ImpactPreset>> found;
  for (auto&& [key, node] : document) {
    if (key.str() == "format") continue;
    const toml::table* presets = node.as_table();
    if (key.str() != "preset" || !presets)
      return preset_error(file, node.source(), fmt::format("unknown key '{}'", std::string(key.str())),
                          "write presets as tables, [preset.NAME]");
    for (auto&& [name, entry] : *presets) {
      const toml::table* table = entry.as_table();
      if (!table)
        return preset_error(file, entry.source(),
                            fmt::format("'{}' is not a preset", std::string(name.str())),
                            "write the preset as a table, [preset.NAME]");
      const auto preset = PresetReader(file, std::string(name.str()), *table).read();
      if (!preset) return preset.error();
      found.emplace_back(table->source().begin, *preset);
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<ImpactPreset> presets;
  for (auto& entry : found) presets.push_back(std::move(entry.second));
  return presets;
}

Vec3 horizontal(const Vec3& v) { return {v.x(), 0.0, v.z()}; }

/// Unit, horizontal.
Vec3 forward_of(const Quat& world_from_pelvis) {
  const Vec3 anterior = world_from_pelvis * Vec3::UnitX();
  const Vec3 flat = horizontal(anterior);
  if (flat.norm() > 0.2) return flat.normalized();
  const Vec3 up = horizontal(world_from_pelvis * Vec3::UnitY());
  return (anterior.y() < 0.0 ? up : Vec3(-up)).normalized();
}

/// Up and to the left in the plane that the blow meets; a vertical blow has no left, and up is forward.
Vec3 aim_offset(const Vec3& direction, const BakeSettings& settings) {
  const Vec3 across = direction.cross(Vec3::UnitY());
  const Vec3 left = across.norm() > 1e-6 ? Vec3(-across.normalized()) : Vec3(Vec3::UnitX());
  const Vec3 up = direction.cross(left);
  return settings.aim_up_m * up + settings.aim_left_m * left;
}

/// The second segment of a blow that hits two: the trunk's neighbour, or the other leg.
Segment beside(Segment target) {
  switch (target) {
    case Segment::pelvis:
    case Segment::chest:
      return Segment::abdomen;
    case Segment::abdomen:
      return Segment::pelvis;
    case Segment::thigh_l:
    case Segment::thigh_r:
    case Segment::shank_l:
    case Segment::shank_r:
    case Segment::foot_l:
    case Segment::foot_r:
      return mirror_of(target);
    default:
      return target;
  }
}

bool is_leg(Segment s) { return s >= Segment::thigh_l && s <= Segment::foot_r; }

/// The leg's foot, or the one that is higher.
Segment caught_foot(Segment target, const BodyPose& start) {
  if (is_leg(target)) return target;
  const auto height = [&](Segment s) { return start[index(s)].translation.y(); };
  return height(Segment::foot_l) > height(Segment::foot_r) ? Segment::foot_l : Segment::foot_r;
}

/// A blast from a point: every segment is pushed away from it by the area that it shows (a solid's grows with
/// its mass to the power 2/3), less where it is farther.
std::vector<Load> blown(const BodyPose& start, const Vec3& point, Sex sex) {
  std::vector<Load> loads;
  double sum = 0.0;
  for (int s = 0; s < kSegmentCount; ++s) {
    const Vec3 away = start[s].translation - point;
    const double weight =
        std::pow(segment_table(segment_at(s), sex).mass_fraction, 2.0 / 3.0) / std::max(away.norm(), 0.1);
    loads.push_back({segment_at(s), weight * away.normalized()});
    sum += weight;
  }
  for (Load& load : loads) load.way /= sum;
  return loads;
}

void load_scene(const ImpactPreset& preset, Sex sex, const BodyPose& start, Scene& scene) {
  switch (scene.kind) {
    case SceneKind::trip:
      scene.target = caught_foot(scene.target, start);
      return;
    case SceneKind::slip:
      scene.direction = -scene.direction;
      scene.slippery_s = preset.slippery_s;
      scene.loads = {{Segment::foot_l, 0.5 * scene.direction}, {Segment::foot_r, 0.5 * scene.direction}};
      return;
    case SceneKind::pull:
      scene.direction = -scene.direction;
      return;
    case SceneKind::explosion:
      scene.loads =
          blown(start, start[index(scene.target)].translation - preset.distance_m * scene.direction, sex);
      return;
    default:
      break;
  }
  const Segment other = beside(scene.target);
  if (preset.spread && other != scene.target && (is_push(scene.kind) || is_impulse(scene.kind)))
    scene.loads = {{scene.target, 0.5 * scene.direction}, {other, 0.5 * scene.direction}};
}

Result<ImpactPreset> preset_named(const std::string& text) {
  static const auto presets = load_presets();  // read once
  if (!presets) return presets.error();
  std::vector<std::string> names;
  for (const ImpactPreset& preset : *presets) {
    if (preset.name == text) return preset;
    names.push_back(preset.name);
  }
  return usage_error(fmt::format("unknown preset '{}'", text), suggestion(text, names));
}

}  // namespace

Result<std::vector<ImpactPreset>> load_presets() {
  const auto path = find_asset("impacts/presets.toml");
  if (!path) return path.error();
  const auto bytes = read_file(*path, 1u << 20);
  if (!bytes) return bytes.error();
  return parse_presets(std::string_view(reinterpret_cast<const char*>(bytes->data()), bytes->size()),
                       path->string());
}

Result<std::vector<ImpactPreset>> parse_presets(std::string_view toml, const std::string& file) {
  try {
    return read_presets(toml::parse(toml, file), file);
  } catch (const toml::parse_error& error) {
    return preset_error(file, error.source(), std::string(error.description()), "correct the TOML syntax");
  }
}

Vec3 travel_direction(const Direction& from, const Quat& world_from_pelvis) {
  const Vec3 forward = forward_of(world_from_pelvis);
  const Vec3 left = Vec3::UnitY().cross(forward);
  const Vec3 flat = std::cos(from.azimuth) * forward + std::sin(from.azimuth) * left;
  const Vec3 origin = std::cos(from.elevation) * flat + std::sin(from.elevation) * Vec3::UnitY();
  return -origin.normalized();
}

Result<SceneKind> parse_scene(std::string_view text) {
  for (std::size_t i = 0; i < kSceneNames.size(); ++i)
    if (text == kSceneNames[i]) return static_cast<SceneKind>(i);
  return usage_error(fmt::format("unknown scene '{}'", text), suggestion(text, kSceneNames));
}

std::string_view name(SceneKind scene) { return kSceneNames[static_cast<std::size_t>(scene)]; }

Result<Scene> scene_of(const BakeSettings& settings, const BodyPose& start) {
  const auto preset = preset_named(settings.preset);
  if (!preset) return preset.error();
  Scene scene;
  scene.kind = settings.scene.value_or(preset->scene);
  scene.target = settings.hit;
  scene.direction = travel_direction(settings.from, start[index(Segment::pelvis)].rotation);
  scene.ball_mass_kg = settings.ball_mass_kg.value_or(preset->mass_kg);
  scene.ball_speed_m_s = settings.strength * settings.ball_speed_m_s.value_or(preset->speed_m_s);
  scene.ball_radius_m = settings.ball_radius_m.value_or(preset->radius_m);
  const double momentum = scene.ball_mass_kg * scene.ball_speed_m_s;
  scene.impulse_n_s = momentum;
  scene.push_duration_s = preset->push_duration_s;
  scene.push_force_n = momentum / scene.push_duration_s;
  scene.fall_height_m = settings.fall_height_m;
  scene.tip_speed_m_s = settings.strength * settings.tip_speed_m_s;
  scene.aim_offset = aim_offset(scene.direction, settings);
  scene.slope_rad = radians(settings.slope_deg);
  load_scene(*preset, settings.sex, start, scene);
  return scene;
}

namespace {

/// As artists call it: "hips", "left upper leg".
std::string in_words(Segment segment) {
  constexpr PerSegment<std::string_view> kWords = {
      "hips",      "waist", "torso",    "head",      "shoulder",  "upper arm",
      "lower arm", "hand",  "shoulder", "upper arm", "lower arm", "hand",
      "upper leg", "calf",  "foot",     "upper leg", "calf",      "foot"};
  const std::string_view paper = name(segment);
  const std::string_view side = paper.ends_with("_l") ? "left " : paper.ends_with("_r") ? "right " : "";
  return fmt::format("{}{}", side, kWords[index(segment)]);
}

}  // namespace

std::string blow_in_words(const BakeSettings& settings, const Scene& scene) {
  const std::string target = in_words(scene.target);
  const std::string& side = settings.from.text;
  switch (scene.kind) {
    case SceneKind::none:
      return "unhit";
    case SceneKind::fall:
      return fmt::format("falls away from {}", side);
    case SceneKind::slip:
      return fmt::format("the feet slip away to {}", side);
    case SceneKind::pull:
      return fmt::format("{} pulled to {}", target, side);
    default:
      return fmt::format("{} hit from {}", target, side);
  }
}

Status check_preset(const std::string& text) {
  const auto preset = preset_named(text);
  return preset ? Status(Done{}) : Status(preset.error());
}

std::optional<std::string> preset_in_use(const BakeSettings& settings) {
  const bool own_ball = settings.ball_mass_kg && settings.ball_speed_m_s && settings.ball_radius_m;
  if (own_ball || settings.scene == SceneKind::fall || settings.scene == SceneKind::none) return std::nullopt;
  return settings.preset;
}

}  // namespace ukemi
