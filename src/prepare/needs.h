// Settings that do nothing without another one.
#pragma once

#include <string>
#include <vector>

#include "base/character.h"
#include "prepare/settings.h"
#include "simulate/simulate.h"

namespace ukemi {

/// Warnings about settings that differ from their defaults but have no effect: "--return-to has no
/// effect without --return". `scene`: the one in force.
std::vector<std::string> idle_settings(const BakeSettings& settings, SceneKind scene);

/// The same of settings that this character leaves without effect.
std::vector<std::string> idle_settings(const BakeSettings& settings, const Character& character);

}  // namespace ukemi
