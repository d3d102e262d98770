// The settings of a bake as options of a command.
#pragma once

#include "cli/options.h"
#include "humanoid/humanoid.h"
#include "prepare/settings.h"

namespace ukemi {

/// How a file's skeleton is read: --map --unit --up --height.
void declare_humanoid_options(Options& options, HumanoidOptions& target);

/// Every setting of a bake, under the headings of its groups.
void declare_bake_options(Options& options, BakeSettings& target);

}  // namespace ukemi
