// What a reaction is made from, as one digest: as long as it stays, so does the reaction.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/result.h"
#include "batch/recipe.h"

namespace ukemi {

/// Digests of reactions; every file is read once.
class InputDigests {
 public:
  explicit InputDigests(const Recipe& recipe) : recipe_(recipe) {}

  /// Over the program's version and own tables, the character's bytes (with the buffers and images that a
  /// .gltf names), every setting in force, the bytes of the files that settings name, the range of motion,
  /// the reaction's name and its kinds of output. Pictures beside an FBX or DAE are not looked at. Errors:
  /// input (cannot be read).
  Result<std::string> of(const Reaction& reaction);

 private:
  Result<std::string> of_file(const std::filesystem::path& file);
  Result<std::string> of_region(const std::string& region);
  Result<std::string> of_program();

  const Recipe& recipe_;
  std::map<std::string, std::string> files_, regions_;
  std::string program_;
};

}  // namespace ukemi
