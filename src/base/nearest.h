// "Did you mean": the known word nearest to what was typed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ukemi {

/// Number of insertions, deletions, replacements and swaps of neighbours that take `a` to `b`.
int edit_distance(std::string_view a, std::string_view b);

/// The known word with the smallest edit distance to `word` (case ignored), the first of equals; empty when
/// none is near enough (a third of the longer word, at least 2).
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

/// "did you mean 'X'?" for a near word, else "choose one of: a b c".
std::string suggestion(std::string_view word, const std::vector<std::string>& known);

}  // namespace ukemi
