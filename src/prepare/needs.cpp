#include "prepare/needs.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "prepare/setting_table.h"

namespace ukemi {
namespace {

struct Given {
  const BakeSettings& settings;
  SceneKind scene;
};

struct Need {
  std::vector<std::string_view> names;  // of settings
  std::string_view without;             // "--recover"
  bool (*met)(const Given&);
};

bool is_one_of(SceneKind scene, std::initializer_list<SceneKind> kinds) {
  return std::find(kinds.begin(), kinds.end(), scene) != kinds.end();
}

bool is_alive(const Given& given) { return behaviour_settings(given.settings).kind != Behaviour::limp; }

/// True where no file is asked for (a bake in memory) or one has an ending of these.
bool writes(const Given& given, std::initializer_list<std::string_view> endings) {
  const auto& outputs = given.settings.outputs;
  return outputs.empty() || std::any_of(outputs.begin(), outputs.end(), [&](const auto& path) {
           return std::find(endings.begin(), endings.end(), path.extension().string()) != endings.end();
         });
}

bool writes_gltf(const Given& given) { return writes(given, {".glb", ".gltf", ".vrm"}); }

const std::vector<Need>& needs() {
  using enum SceneKind;
  static const std::vector<Need> table = {
      {{"ball-radius", "aim-up", "aim-left"},
       "a scene with a ball or a box",
       [](const Given& g) {
         return is_one_of(g.scene, {ball, slope, box});
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
      {{"muscle", "breath"},
       "a body that is alive (--behaviour) or gets up",
       [](const Given& g) { return is_alive(g) || g.settings.get_up_s.has_value(); }},
      {{"tone", "tone-fade"}, "--behaviour limp", [](const Given& g) { return !is_alive(g); }},
      {{"assist"}, "--outcome", [](const Given& g) { return g.settings.outcome.has_value(); }},
      {{"get-up-style"}, "--get-up", [](const Given& g) { return g.settings.get_up_s.has_value(); }},
      {{"active-k", "active-file", "active-delay"},
       "the active restriction (--active)",
       [](const Given& g) { return g.settings.simulation.active != Active::off; }},
      {{"hold"}, "--until-rest", [](const Given& g) { return g.settings.until_rest; }},
      {{"to"},
       "--recover",
       [](const Given& g) {
         return g.settings.recover_s.has_value() || g.settings.recover_to == RecoverTo::stance;
       }},
      {{"extra-bones", "ground-speed"},
       "a start --clip",
       [](const Given& g) { return g.settings.clip.has_value(); }},
      {{"keys", "rotation-type", "all-joints"}, "a glTF to write", writes_gltf},
      {{"clip-only"},
       "a glTF or FBX to write",
       [](const Given& g) { return writes_gltf(g) || writes(g, {".fbx"}); }},
      {{"root-motion"},
       "a glTF or FBX to write: a BVH has it on the hips",
       [](const Given& g) {
         return g.settings.ground.root_motion != RootMotion::root || writes_gltf(g) || writes(g, {".fbx"});
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
        said.push_back(fmt::format("--{} has no effect without {}", name, need.without));
    }
  }
  return said;
}

}  // namespace ukemi
