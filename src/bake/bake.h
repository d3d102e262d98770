// The rooms in a row: a character and an impact in, a clip, its pictures and its report out.
#pragma once

#include <string>

#include "bake/baked.h"
#include "bake/search.h"
#include "base/character.h"
#include "base/files.h"
#include "base/result.h"
#include "prepare/settings.h"

namespace ukemi {

/// What is wrong with the settings, told without a character: words, numbers, outputs (extension, folder,
/// twice the same). Errors: usage, output.
Status check_settings(const std::string& character, const BakeSettings& settings);

/// Runs the stages on a loaded character. Errors: those of the stages.
Result<BakedClip> bake(const Character& character, const BakeSettings& settings, Diagnostics& diagnostics,
                       const SearchRun& run = {});

/// Bakes a loaded character and makes every file that the settings name; nothing is written, the report not
/// made. Errors: those of the stages.
Result<BakedFile> bake_loaded(const Character& character, const BakeSettings& settings,
                              Diagnostics& diagnostics, const SearchRun& run = {});

/// Lays the files beside their targets and counts the time. Errors: output.
Status add_files(BakedFile& baked, PendingFiles& files);

/// Writes the clips and the pictures of a bake. Errors: output.
Status write_files(BakedFile& baked);

/// Loads, bakes and writes every output. `character` is a file or "mannequin". Nothing is written when
/// anything fails before the first write.
Result<BakedFile> bake_file(const std::string& character, const BakeSettings& settings,
                            Diagnostics& diagnostics, const SearchRun& run = {});

}  // namespace ukemi
