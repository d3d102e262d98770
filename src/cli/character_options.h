// Options that say how a file's skeleton is read, the same for every command that reads one.
#pragma once

#include "cli/options.h"
#include "humanoid/humanoid.h"

namespace ukemi {

/// --map --unit --up --height.
void declare_humanoid_options(Options& options, HumanoidOptions& target);

}  // namespace ukemi
