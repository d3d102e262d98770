#include "export/root_joint.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "base/errors.h"
#include "export/container.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

/// Puts `fresh` in the place of `old` in a list of children.
void replace_in(Json& list, int old, int fresh) {
  for (Json& entry : list)
    if (entry.is_number_integer() && entry.get<int>() == old) entry = fresh;
}

/// A buffer of the document that takes more bytes: the binary chunk, or a further buffer in the JSON. Returns
/// its view.
std::size_t add_view(Json& json, GltfDocument& document, const std::vector<float>& values) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
  const std::vector<std::uint8_t> bytes(first, first + values.size() * sizeof(float));
  const bool chunk = document.is_glb && !json.value("buffers", Json::array()).empty() &&
                     !json["buffers"][0].contains("uri") && !document.buffers.empty();
  if (!chunk) {
    json["buffers"].push_back({{"byteLength", 0}, {"uri", data_uri("application/octet-stream", bytes)}});
    document.buffers.emplace_back();
  }
  const std::size_t index = chunk ? 0 : json["buffers"].size() - 1;
  std::vector<std::uint8_t>& buffer = document.buffers[index];
  buffer.resize((buffer.size() + 3) / 4 * 4);
  json["bufferViews"].push_back(
      {{"buffer", index}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}});
  buffer.insert(buffer.end(), bytes.begin(), bytes.end());
  json["buffers"][index]["byteLength"] = buffer.size();
  return json["bufferViews"].size() - 1;
}

/// Where the joint is when the skin is bound: beside a bone of it as in the rest pose.
Affine bound_at(const Skeleton& skeleton, const Skin& skin, int joint, int beside) {
  const std::vector<Affine> rest = world_transforms(skeleton, rest_pose(skeleton));
  const auto known = std::find(skin.joints.begin(), skin.joints.end(), beside);
  const auto i = known == skin.joints.end() ? 0 : known - skin.joints.begin();
  return skin.inverse_bind[i].inverse() * rest[skin.joints[i]].inverse() * rest[joint];
}

/// Adds the joint to the skins that have bones below it.
void add_to_skins(Json& json, Character& character, int joint, int hips) {
  for (std::size_t i = 0; i < character.skins.size(); ++i) {
    Skin& skin = character.skins[i];
    const bool below = std::any_of(skin.joints.begin(), skin.joints.end(),
                                   [&](int bone) { return character.skeleton.is_ancestor(joint, bone); });
    if (!below) continue;
    skin.inverse_bind.push_back(bound_at(character.skeleton, skin, joint, hips).inverse());
    skin.joints.push_back(joint);
    std::vector<float> matrices;
    for (const Affine& bind : skin.inverse_bind)
      for (int k = 0; k < 16; ++k) matrices.push_back(static_cast<float>(bind.matrix()(k % 4, k / 4)));
    const std::size_t view = add_view(json, character.document, matrices);
    json["accessors"].push_back(
        {{"bufferView", view}, {"componentType", 5126}, {"count", skin.joints.size()}, {"type", "MAT4"}});
    Json& target = json["skins"][i];
    target["joints"].push_back(joint);
    target["inverseBindMatrices"] = json["accessors"].size() - 1;
    if (target.contains("skeleton") && target["skeleton"] == hips) target["skeleton"] = joint;
  }
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
  add_to_skins(json, character, fresh, hips);
  character.document.json = json.dump();
  return character;
} catch (const std::exception& e) {
  return input_error(source.path, std::string("the glTF document cannot take a root joint: ") + e.what(),
                     "check the file with the Khronos glTF validator");
}

}  // namespace ukemi
