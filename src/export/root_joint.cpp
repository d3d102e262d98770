#include "export/root_joint.h"

#include <nlohmann/json.hpp>
#include <string>

#include "base/errors.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

/// Puts `fresh` in the place of `old` in a list of children.
void replace_in(Json& list, int old, int fresh) {
  for (Json& entry : list)
    if (entry.is_number_integer() && entry.get<int>() == old) entry = fresh;
}

}  // namespace

Result<Character> with_root_joint(const Character& source, int hips) try {
  Character character = source;
  Skeleton& skeleton = character.skeleton;
  const int fresh = skeleton.size();
  const int parent = skeleton.nodes[hips].parent;
  const std::string name = skeleton.find("root") < 0 ? "root" : "ukemi_root";
  skeleton.nodes.push_back({name, parent, {}});
  skeleton.nodes[hips].parent = fresh;
  const bool sorted = skeleton.sort();
  static_cast<void>(sorted);  // a chain of parents stays one
  Json json = Json::parse(character.document.json);
  json["nodes"].push_back({{"name", name}, {"children", {hips}}});
  if (parent >= 0)
    replace_in(json["nodes"][parent]["children"], hips, fresh);
  else if (json.contains("scenes"))
    for (Json& scene : json["scenes"])
      if (scene.contains("nodes")) replace_in(scene["nodes"], hips, fresh);
  character.document.json = json.dump();
  return character;
} catch (const std::exception& e) {
  return input_error(source.path, std::string("the glTF document cannot take a root joint: ") + e.what(),
                     "check the file with the Khronos glTF validator");
}

}  // namespace ukemi
