// The bones that the user names.
#include <fmt/format.h>

#include <charconv>

#include "base/errors.h"
#include "base/nearest.h"
#include "bones/bones.h"

namespace ukemi {
namespace {

constexpr std::size_t kMostListed = 8;

/// Nodes of that name, as "#4, #21".
std::string places_of(const Skeleton& skeleton, const std::string& name) {
  std::vector<std::string> places;
  for (int i = 0; i < skeleton.size(); ++i)
    if (skeleton.nodes[i].name == name) places.push_back(fmt::format("#{}", i));
  if (places.size() > kMostListed) {
    places.resize(kMostListed);
    places.emplace_back("...");
  }
  return fmt::format("{}", fmt::join(places, ", "));
}

bool is_number_label(const std::string& label) {
  int number = 0;
  const char* const end = label.data() + label.size();
  if (label.size() < 2 || label[0] != '#') return false;
  const auto parsed = std::from_chars(label.data() + 1, end, number);
  return parsed.ec == std::errc() && parsed.ptr == end;
}

Error no_such_node(const Character& character, const std::string& label) {
  const Skeleton& skeleton = character.skeleton;
  if (const std::string places = places_of(skeleton, label); !places.empty())
    return usage_error(character.path, fmt::format("several nodes are called '{}'", label),
                       fmt::format("name one of them by its number: {}", places));
  if (is_number_label(label))
    return usage_error(character.path, fmt::format("there is no node {}", label),
                       fmt::format("the file has nodes #0 to #{}", skeleton.size() - 1));
  std::vector<std::string> known;
  for (int i = 0; i < skeleton.size(); ++i) known.push_back(skeleton.label(i));
  const std::string near = nearest_word(label, known);
  return usage_error(character.path, fmt::format("there is no node '{}'", label),
                     near.empty() ? "give a node's unique name, or its #INDEX in the file"
                                  : fmt::format("did you mean '{}'?", near));
}

}  // namespace

Result<int> node_of_label(const Character& character, const std::string& label) {
  const int node = character.skeleton.find(label);
  if (node < 0) return no_such_node(character, label);
  return node;
}

Status apply_user_map(const Character& character, const HumanoidOptions& options, Bones& bones) {
  for (const auto& [segment_name, label] : options.map) {
    const auto segment = segment_named(segment_name);
    if (!segment) {
      std::vector<std::string> known;
      for (int i = 0; i < kSegmentCount; ++i) known.emplace_back(name(segment_at(i)));
      return usage_error(character.path, fmt::format("there is no segment '{}'", segment_name),
                         suggestion(segment_name, known));
    }
    const auto node = node_of_label(character, label);
    if (!node) return error_about(segment_name, node.error());
    for (int s = 0; s < kSegmentCount; ++s)
      if (bones.node[s] == *node)
        return error_about(segment_name, usage_error(character.path,
                                                     fmt::format("'{}' is said to be both {} and {}", label,
                                                                 name(segment_at(s)), segment_name),
                                                     "give each segment a node of its own"));
    bones.set(*segment, *node, "user");
  }
  return Done{};
}

}  // namespace ukemi
