#include "prepare/needs.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "clip/names.h"
#include "prepare/setting_table.h"

namespace ukemi {
namespace {

struct Given {
  const BakeSettings& settings;
  SceneKind scene;
};

struct Need {
  std::vector<std::string_view> names;  // of settings
  std::string_view without;             // "--return"
  bool (*met)(const Given&);
};

bool is_one_of(SceneKind scene, std::initializer_list<SceneKind> kinds) {
  return std::find(kinds.begin(), kinds.end(), scene) != kinds.end();
}

bool is_alive(const Given& given) { return behaviour_settings(given.settings).kind != Behaviour::limp; }

bool lives_or_gets_up(const Given& given) {
  return is_alive(given) || gets_up_after_s(given.settings).has_value();
}

bool draws(const BakeSettings& settings) { return !settings.sheet.empty() || !settings.preview.empty(); }

std::string ending(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// True where no file is asked for (a bake in memory, a report alone) or one has an ending of these.
bool writes(const Given& given, std::initializer_list<std::string_view> endings) {
  const auto& outputs = given.settings.outputs;
  if (outputs.empty()) return !draws(given.settings);
  return std::any_of(outputs.begin(), outputs.end(), [&](const auto& path) {
    return std::find(endings.begin(), endings.end(), ending(path)) != endings.end();
  });
}

bool writes_clip(const Given& given) { return !given.settings.outputs.empty() || !draws(given.settings); }

bool writes_gltf(const Given& given) { return writes(given, {".glb", ".gltf", ".vrm"}); }

const std::vector<Need>& needs() {
  using enum SceneKind;
  static const std::vector<Need> table = {
      {{"ball-radius"},
       "a scene with a ball or a box",
       [](const Given& g) {
         return is_one_of(g.scene, {ball, slope, box});
       }},
      {{"aim-up", "aim-left"},
       "a ball or a box that is aimed (--scene ball or box)",
       [](const Given& g) {
         return is_one_of(g.scene, {ball, box});
       }},
      {{"ball-mass", "ball-speed", "strength", "hit"},
       "a scene that hits",
       [](const Given& g) {
         return !is_one_of(g.scene, {fall, none});
       }},
      {{"from"}, "a scene where something happens", [](const Given& g) { return g.scene != none; }},
      {{"slope-deg"}, "--scene slope", [](const Given& g) { return g.scene == slope; }},
      {{"fall-height", "tip-speed"}, "--scene fall", [](const Given& g) { return g.scene == fall; }},
      {{"steps", "outcome", "search", "arms", "latency"}, "a body that is alive (--behaviour)", is_alive},
      {{"muscle", "breath", "seed"}, "a body that is alive (--behaviour) or gets up", lives_or_gets_up},
      {{"tone", "tone-fade"}, "--behaviour limp", [](const Given& g) { return !is_alive(g); }},
      {{"tone-fade"},
       "--stiffness above 0",
       [](const Given& g) { return is_alive(g) || tone_of(g.settings.simulation) > 0.0; }},
      {{"assist"}, "--outcome", [](const Given& g) { return g.settings.outcome.has_value(); }},
      {{"get-up-style"}, "--get-up", [](const Given& g) { return gets_up_after_s(g.settings).has_value(); }},
      {{"active-k", "active-file", "active-delay"},
       "the active restriction (--active)",
       [](const Given& g) { return g.settings.simulation.active != Active::off; }},
      {{"hold"}, "--until-rest", [](const Given& g) { return g.settings.until_rest; }},
      {{"to"},
       "--return",
       [](const Given& g) {
         return g.settings.recover_s.has_value() || g.settings.recover_to == RecoverTo::stance ||
                (g.settings.recover_to == RecoverTo::clip && g.settings.clip && is_alive(g));
       }},
      {{"to"},
       "a body that is alive (--behaviour): it ends as it comes to rest",
       [](const Given& g) { return g.settings.recover_to != RecoverTo::stance || is_alive(g); }},
      {{"extra-bones", "ground-speed"},
       "a start --clip",
       [](const Given& g) { return g.settings.clip.has_value(); }},
      {{"align", "root-motion"}, "a clip to write", writes_clip},
      {{"keys", "rotation-type", "all-joints", "additive"}, "a glTF to write", writes_gltf},
      {{"clip-only"},
       "a glTF or FBX to write",
       [](const Given& g) { return writes_gltf(g) || writes(g, {".fbx"}); }},
      {{"root-motion"},
       "a glTF or FBX to write: a BVH has it on the hips",
       [](const Given& g) {
         return g.settings.ground.root_motion != RootMotion::root || !writes_clip(g) || writes_gltf(g) ||
                writes(g, {".fbx"});
       }},
      {{"key-error-mm"},
       "reduced keys of a glTF to write",
       [](const Given& g) { return g.settings.keys.enabled && writes_gltf(g); }},
      {{"bvh-unit"}, "a BVH to write", [](const Given& g) { return writes(g, {".bvh"}); }},
  };
  return table;
}

}  // namespace

std::vector<std::string> idle_settings(const BakeSettings& settings, SceneKind scene) {
  static const BakeSettings defaults;
  const Given given{settings, scene};
  std::vector<std::string> said;
  for (const Need& need : needs()) {
    if (need.met(given)) continue;
    for (const std::string_view name : need.names) {
      const auto setting = find_setting(name);
      if (setting && (*setting)->get(settings) != (*setting)->get(defaults))
        said.push_back(fmt::format("--{} has no effect without {}", (*setting)->shown(), need.without));
    }
  }
  if (settings.theme != defaults.theme && !draws(settings))
    said.push_back("--theme has no effect without a picture (--sheet, --preview)");
  return said;
}

std::vector<std::string> idle_settings(const BakeSettings& settings, const Character& character) {
  std::vector<std::string> said;
  if (settings.bvh_metres_per_unit && character.bvh)
    said.push_back("--bvh-unit has no effect: a character from a BVH keeps the unit of its file");
  if (settings.all_joints && character.skins.empty())
    said.push_back("--all-joints has no effect: the character has no skin");
  if (settings.extra_bones_play && settings.clip && !find_clip(character, *settings.clip))
    said.push_back(
        "--extra-bones clip has no effect: a start clip of another file moves the character's segments "
        "alone");
  return said;
}

}  // namespace ukemi
