#include "review/mesh.h"

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "base/digest.h"
#include "export/container.h"
#include "export/stick_mesh.h"
#include "review/json.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

Json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json numbers(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }

Json nodes_json(const Skeleton& skeleton) {
  Json nodes = Json::array();
  for (const Node& node : skeleton.nodes)
    nodes.push_back({{"name", node.name},
                     {"parent", node.parent},
                     {"position", numbers(node.rest.translation)},
                     {"quaternion", numbers(node.rest.rotation)},
                     {"scale", numbers(node.rest.scale)}});
  return nodes;
}

/// All components of fixed-size vectors in a row.
template <typename Vector>
std::vector<float> flat(const std::vector<Vector>& vectors) {
  std::vector<float> values;
  values.reserve(vectors.size() * 3);
  for (const Vector& vector : vectors)
    for (std::size_t i = 0; i < static_cast<std::size_t>(vector.size()); ++i) values.push_back(vector[i]);
  return values;
}

Json part_json(const MeshPart& part) {
  Json json{{"node", part.node}, {"skin", part.skin}, {"material", part.material}};
  json["positions"] = packed(flat(part.positions));
  if (!part.normals.empty()) json["normals"] = packed(flat(part.normals));
  if (!part.uvs.empty()) json["uvs"] = packed(flat(part.uvs));
  if (!part.colors.empty()) json["colors"] = packed(flat(part.colors));
  if (part.skin >= 0) {
    std::vector<std::uint16_t> joints;
    for (const auto& four : part.joints) joints.insert(joints.end(), four.begin(), four.end());
    json["joints"] = packed(joints);
    json["weights"] = packed(flat(part.weights));
  }
  json["indices"] = packed(part.indices);
  return json;
}

void put_matrix(std::vector<float>& values, const Affine& transform) {
  const Eigen::Matrix4f matrix = transform.matrix().cast<float>();
  values.insert(values.end(), matrix.data(), matrix.data() + 16);  // column by column, as three.js reads it
}

Json skin_json(const std::vector<int>& joints, const std::vector<Affine>& inverse_bind) {
  std::vector<float> matrices;
  for (const Affine& transform : inverse_bind) put_matrix(matrices, transform);
  return {{"joints", joints}, {"inverse_bind", packed(matrices)}};
}

const char* name_of(Material::Alpha alpha) {
  switch (alpha) {
    case Material::Alpha::mask:
      return "mask";
    case Material::Alpha::blend:
      return "blend";
    case Material::Alpha::opaque:
      break;
  }
  return "opaque";
}

/// `page_image`: of the character's images, the number that the page knows each by; -1 for the others.
Json materials_json(const Character& character, const std::map<int, int>& page_image) {
  Json materials = Json::array();
  for (const Material& material : character.materials) {
    const auto image = page_image.find(material.base_color_image);
    materials.push_back({{"color", material.base_color},
                         {"image", image == page_image.end() ? -1 : image->second},
                         {"alpha", name_of(material.alpha)},
                         {"cutoff", material.alpha_cutoff},
                         {"double_sided", material.double_sided}});
  }
  return materials;
}

/// Those that visible parts show.
std::map<int, int> page_images(const Character& character) {
  std::map<int, int> images;
  for (const MeshPart& part : character.parts) {
    const int image = part.material < 0 ? -1 : character.materials[part.material].base_color_image;
    if (image >= 0 && !part.uvs.empty()) images.emplace(image, static_cast<int>(images.size()));
  }
  return images;
}

void add_images(const Character& character, const std::map<int, int>& page_image, Json& json) {
  std::vector<int> images(page_image.size());
  for (const auto& [image, number] : page_image) images[static_cast<std::size_t>(number)] = image;
  json["images"] = Json::array();
  for (const int image : images)
    json["images"].push_back(data_uri(character.images[image].mime, character.images[image].bytes));
}

/// The simple figure as one part with a skin.
void add_figure(const Character& character, const Humanoid& humanoid, Json& json) {
  const StickMesh mesh = make_stick_mesh(character, humanoid);
  MeshPart part;
  part.skin = 0;
  part.positions = mesh.positions;
  part.normals = mesh.normals;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    part.joints.push_back({static_cast<std::uint16_t>(mesh.nodes[i]), 0, 0, 0});
    part.weights.push_back({1.0f, 0.0f, 0.0f, 0.0f});
    part.indices.push_back(static_cast<std::uint32_t>(i));
  }
  std::vector<int> joints;
  for (int i = 0; i < character.skeleton.size(); ++i) joints.push_back(i);
  json["parts"].push_back(part_json(part));
  json["skins"].push_back(skin_json(joints, mesh.inverse_bind));
}

}  // namespace

namespace {

template <typename Values>
void add_values(Digest& digest, const Values& values) {
  digest.add_field(
      std::string_view(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(*values.data())));
}

/// Of all that mesh_json reads of parts, skins and images beside what stands in short_json.
std::string digest_of_arrays(const Character& character) {
  Digest digest;
  for (const MeshPart& part : character.parts) {
    add_values(digest, part.positions);
    add_values(digest, part.normals);
    add_values(digest, part.uvs);
    add_values(digest, part.colors);
    add_values(digest, part.joints);
    add_values(digest, part.weights);
    add_values(digest, part.indices);
    add_values(digest, std::array{part.node, part.skin, part.material});
  }
  for (const Skin& skin : character.skins) {
    add_values(digest, skin.joints);
    for (const Affine& bind : skin.inverse_bind) add_values(digest, bind.matrix());
  }
  for (const Image& image : character.images) {
    digest.add_field(image.mime);
    add_values(digest, image.bytes);
  }
  return digest.hex();
}

/// Everything but the long arrays.
Json short_json(const Character& character, const Humanoid& humanoid) {
  const Similarity& world = humanoid.world_from_file;
  Json json;
  json["world_from_file"] = {{"scale", world.scale},
                             {"quaternion", numbers(world.rotation)},
                             {"position", numbers(world.translation)}};
  json["height_m"] = humanoid.height_m;
  json["nodes"] = nodes_json(character.skeleton);
  json["parts"] = Json::array();
  json["skins"] = Json::array();
  json["images"] = Json::array();
  json["materials"] = materials_json(character, page_images(character));
  return json;
}

std::string mesh_json(const Character& character, const Humanoid& humanoid, Json json) {
  add_images(character, page_images(character), json);
  if (character.parts.empty()) {
    add_figure(character, humanoid, json);
  } else {
    for (const MeshPart& part : character.parts)
      if (!part.indices.empty()) json["parts"].push_back(part_json(part));
    for (const Skin& skin : character.skins)
      json["skins"].push_back(skin_json(skin.joints, skin.inverse_bind));
  }
  return script_safe(json.dump(-1, ' ', true, Json::error_handler_t::replace));
}

}  // namespace

std::shared_ptr<const ReviewMesh> review_mesh(const Character& character, const Humanoid& humanoid) {
  thread_local std::string kept_key;
  thread_local std::shared_ptr<const ReviewMesh> kept;
  Json json = short_json(character, humanoid);
  std::string key = json.dump(-1, ' ', true, Json::error_handler_t::replace) + digest_of_arrays(character);
  if (character.parts.empty() || key != kept_key) {
    ReviewMesh mesh{mesh_json(character, humanoid, std::move(json)), {}};
    mesh.hash = content_hash(mesh.json);
    kept = std::make_shared<const ReviewMesh>(std::move(mesh));
    kept_key = std::move(key);
  }
  return kept;
}

}  // namespace ukemi
