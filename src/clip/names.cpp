#include "clip/names.h"

#include <fmt/format.h>

#include <charconv>
#include <vector>

#include "base/errors.h"
#include "base/nearest.h"

namespace ukemi {

bool is_motion_only(const Character& character) {
  if (character.animations.empty()) return false;
  if (character.format == SourceFormat::bvh) return true;
  return character.parts.empty() && character.skins.empty() && character.animations.size() == 1;
}

std::string clip_label(const Character& character, std::size_t clip) {
  const std::string& name = character.animations[clip].name;
  return name.empty() ? fmt::format("#{}", clip) : name;
}

Result<std::size_t> find_clip(const Character& character, std::string_view name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < character.animations.size(); ++i) {
    names.push_back(clip_label(character, i));
    if (names.back() == name) return i;
  }
  std::size_t number = 0;
  const char* end = name.data() + name.size();
  if (name.size() > 1 && name.front() == '#') {
    const auto [parsed, error] = std::from_chars(name.data() + 1, end, number);
    if (error == std::errc() && parsed == end && number < names.size()) return number;
  }
  const std::string what = fmt::format("{} has no clip '{}'", character.path.string(), name);
  return usage_error(what, names.empty() ? "the file holds no clips; use --pose" : suggestion(name, names));
}

}  // namespace ukemi
