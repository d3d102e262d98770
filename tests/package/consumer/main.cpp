// Says how many nodes a character has and how many of the 18 segments were found in it.
#include <cstdio>

#include "humanoid/humanoid.h"
#include "load/load.h"

int main(int count, char** arguments) {
  if (count != 2) return 2;
  ukemi::Diagnostics diagnostics;
  const auto character = ukemi::load_character(arguments[1], {}, diagnostics);
  if (!character) {
    std::fprintf(stderr, "%s\n", character.error().message().c_str());
    return 1;
  }
  const auto humanoid = ukemi::map_humanoid(*character, {}, diagnostics);
  if (!humanoid) {
    std::fprintf(stderr, "%s\n", humanoid.error().message().c_str());
    return 1;
  }
  int found = 0;
  for (const ukemi::SegmentNodes& nodes : humanoid->segments) found += nodes.fused() ? 0 : 1;
  std::printf("%s: %zu nodes, %d segments\n", character->name.c_str(), character->skeleton.nodes.size(),
              found);
  return 0;
}
