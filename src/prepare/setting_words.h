// What artists call the settings, and which settings most people need.
#pragma once

#include <string_view>
#include <vector>

namespace ukemi {

/// The artists' words for a setting that records call `name`; the first is the one to show. Mostly empty.
std::vector<std::string_view> other_words(std::string_view name);

/// Whether `bake --help` shows it; `bake --help-all` shows every setting.
bool is_everyday(std::string_view name);

}  // namespace ukemi
