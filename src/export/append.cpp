#include "export/append.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "base/files.h"
#include "load/load.h"

namespace ukemi {

Result<Character> file_to_append_to(const std::filesystem::path& path, const Character& character) {
  Diagnostics unsaid;  // said when the character was loaded
  auto earlier = load_character(path, LoadOptions{}, unsaid);
  if (!earlier) return earlier.error();
  const auto differs = [&](int node) {
    return error_about(character.skeleton.label(node),
                       input_error(path,
                                   fmt::format("holds another skeleton than {}, so no clip can be appended",
                                               character.path.string()),
                                   "bake with the settings of the first clip, or write another file"));
  };
  for (int i = 0; i < character.skeleton.size(); ++i) {
    if (i >= earlier->skeleton.size()) return differs(i);
    const Node& theirs = earlier->skeleton.nodes[i];
    const Node& ours = character.skeleton.nodes[i];
    const bool same_parent =
        theirs.parent == ours.parent || (ours.parent < 0 && theirs.parent >= character.skeleton.size());
    if (theirs.name != ours.name || !same_parent) return differs(i);
  }
  return earlier;
}

}  // namespace ukemi
