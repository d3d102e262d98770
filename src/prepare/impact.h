// What hits: presets, directions, and the scene that they make.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"
#include "base/result.h"
#include "humanoid/humanoid.h"
#include "prepare/direction.h"
#include "simulate/simulate.h"

namespace ukemi {

struct BakeSettings;

/// One table [preset.NAME] of assets/impacts/presets.toml.
struct ImpactPreset {
  std::string name;
  SceneKind scene = SceneKind::ball;
  double mass_kg = 0.0;
  double speed_m_s = 0.0;
  double radius_m = 0.0;
  bool stylised = false;         // stronger than the real thing, for the eye
  double push_duration_s = 0.2;  // used by a push, a pull, a trip, a slip
  double distance_m = 3.0;       // explosion: from its point to the target
  double slippery_s = 0.0;       // slip: the soles find little hold for so long
  bool spread = false;           // half of it goes to the segment beside the target
};

/// The presets that come with the program, in the file's order.
Result<std::vector<ImpactPreset>> load_presets();
/// Errors: input, with line and column (syntax, unknown or missing key, value that is not above 0).
Result<std::vector<ImpactPreset>> parse_presets(std::string_view toml, const std::string& file);

/// Unit vector the blow travels along. Forward is the pelvis's anterior axis made horizontal; for a pelvis
/// that lies on its front or back, the way its head or feet point.
Vec3 travel_direction(const Direction& from, const Quat& world_from_pelvis);

/// Whether there is a preset of that name. Errors: usage, with the nearest name.
Status check_preset(const std::string& name);

Result<SceneKind> parse_scene(std::string_view text);
std::string_view name(SceneKind scene);

/// The blow of a bake on a body that is in `start`: the preset's numbers, replaced by what the settings give.
/// A trip takes the foot that is in the air where the target is no leg. A push or an impulse without numbers
/// of its own carries the ball's momentum. Errors: usage (unknown preset), input (presets file).
Result<Scene> scene_of(const BakeSettings& settings, const BodyPose& start);

/// "torso hit from front", "left foot pulled to back", "unhit": what happens, in artists' words, for a title.
std::string blow_in_words(const BakeSettings& settings, const Scene& scene);

/// The preset whose numbers are used, or nothing where the settings replace them all.
std::optional<std::string> preset_in_use(const BakeSettings& settings);

}  // namespace ukemi
