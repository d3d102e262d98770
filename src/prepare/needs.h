// Settings that do nothing without another one.
#pragma once

#include <string>
#include <vector>

#include "prepare/settings.h"
#include "simulate/simulate.h"

namespace ukemi {

/// What is said of the settings that differ from their defaults and have no effect: "--to has no effect
/// without --recover". `scene`: the one in force.
std::vector<std::string> idle_settings(const BakeSettings& settings, SceneKind scene);

}  // namespace ukemi
