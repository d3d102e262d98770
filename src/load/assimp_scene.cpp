#include "load/assimp_scene.h"

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/errors.h"
#include "base/files.h"
#include "load/gltf_reader.h"
#include "load/load.h"
#include "load/text.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kKnownExtensions = "use a .glb, .gltf, .vrm, .fbx, .dae or .bvh file";
constexpr int kFloat = 5126;
constexpr int kUint16 = 5123;
constexpr int kUint32 = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementBuffer = 34963;
// Keys nearer than this are merged: some files hold keys whose times are equal as float seconds.
constexpr double kMinKeyDistance_s = 1e-4;

std::string name_of(const aiString& name) { return load::utf8_name({name.data, name.length}); }

/// Appends numbers to one buffer, an accessor each.
class BufferWriter {
 public:
  /// Accessor over `numbers`; `type` has `width` components. Limits are written where `with_limits`.
  template <typename Number>
  int add(const std::vector<Number>& numbers, int component_type, const char* type, std::size_t width,
          int target, bool with_limits) {
    const int view =
        add_view({reinterpret_cast<const std::uint8_t*>(numbers.data()), numbers.size() * sizeof(Number)});
    if (target != 0) views_.back()["target"] = target;
    Json accessor{{"bufferView", view},
                  {"componentType", component_type},
                  {"count", numbers.size() / width},
                  {"type", type}};
    if (with_limits) add_limits(numbers, width, accessor);
    accessors_.push_back(std::move(accessor));
    return static_cast<int>(accessors_.size()) - 1;
  }

  int add_view(std::span<const std::uint8_t> bytes) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return static_cast<int>(views_.size()) - 1;
  }

  void finish(load::GltfContainer& container, Json& document) {
    if (bytes_.empty()) return;
    if (!accessors_.empty()) document["accessors"] = std::move(accessors_);
    document["bufferViews"] = std::move(views_);
    document["buffers"] = {{{"byteLength", bytes_.size()}}};
    container.has_binary = true;
    container.binary = std::move(bytes_);
  }

 private:
  template <typename Number>
  static void add_limits(const std::vector<Number>& numbers, std::size_t width, Json& accessor) {
    std::vector<Number> low(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(width));
    std::vector<Number> high = low;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      low[i % width] = std::min(low[i % width], numbers[i]);
      high[i % width] = std::max(high[i % width], numbers[i]);
    }
    accessor["min"] = low;
    accessor["max"] = high;
  }

  std::vector<std::uint8_t> bytes_;
  Json views_ = Json::array();
  Json accessors_ = Json::array();
};

/// The attributes that a primitive's vertices have. In files of polygons every corner is a vertex of its own.
struct Vertices {
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<float> uvs;
  std::vector<std::uint16_t> joints;
  std::vector<float> weights;
  std::vector<std::uint32_t> indices;

  /// Merges vertices that are equal in all attributes, in order of first use, and drops triangles without
  /// area.
  void merge_equal() {
    const std::size_t count = positions.size() / 3;
    std::vector<meshopt_Stream> streams;
    const auto add = [&](const auto& numbers) {
      const std::size_t bytes = numbers.size() * sizeof(numbers[0]) / count;
      if (!numbers.empty()) streams.push_back({numbers.data(), bytes, bytes});
    };
    add(positions), add(normals), add(uvs), add(joints), add(weights);
    std::vector<unsigned> remap(count);
    const std::size_t kept = meshopt_generateVertexRemapMulti(remap.data(), indices.data(), indices.size(),
                                                              count, streams.data(), streams.size());
    const auto apply = [&](auto& numbers) {
      const std::size_t width = numbers.size() / count;
      if (numbers.empty()) return;
      meshopt_remapVertexBuffer(numbers.data(), numbers.data(), count, width * sizeof(numbers[0]),
                                remap.data());
      numbers.resize(kept * width);
    };
    apply(positions), apply(normals), apply(uvs), apply(joints), apply(weights);
    for (std::uint32_t& index : indices) index = remap[index];
    drop_degenerate_triangles();
  }

 private:
  /// Drops triangles of which two corners were merged, unless the mesh has no others.
  void drop_degenerate_triangles() {
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
      if (indices[i] != indices[i + 1] && indices[i + 1] != indices[i + 2] && indices[i + 2] != indices[i])
        kept.insert(kept.end(), &indices[i], &indices[i] + 3);
    if (!kept.empty()) indices = std::move(kept);
  }
};

Eigen::Matrix4d matrix_of(const aiMatrix4x4& m) {
  Eigen::Matrix4d matrix;
  for (unsigned row = 0; row < 4; ++row)
    for (unsigned column = 0; column < 4; ++column) matrix(row, column) = static_cast<double>(m[row][column]);
  return matrix;
}

class SceneConverter {
 public:
  SceneConverter(const aiScene& scene, const std::filesystem::path& path, Diagnostics& diagnostics)
      : scene_(scene), path_(path), diagnostics_(diagnostics) {}

  load::SceneDocument convert() {
    write_nodes();
    write_materials();
    for (std::size_t i = 0; i < nodes_.size(); ++i) write_mesh(static_cast<int>(i));
    write_animations();

    load::SceneDocument result;
    Json document{{"asset", {{"version", "2.0"}, {"generator", "ukemi"}}}, {"scene", 0}};
    document["scenes"] = {{{"nodes", {0}}}};
    document["nodes"] = std::move(node_json_);
    const std::pair<const char*, Json*> parts[] = {{"meshes", &meshes_},       {"skins", &skins_},
                                                   {"materials", &materials_}, {"textures", &textures_},
                                                   {"images", &images_},       {"animations", &animations_}};
    for (const auto& [key, part] : parts)
      if (!part->empty()) document[key] = std::move(*part);
    buffer_.finish(result.container, document);
    result.container.document.json = document.dump();
    read_axes(result);
    return result;
  }

 private:
  void warn(std::string what) { diagnostics_.warn(path_.string(), std::move(what)); }

  /// Nodes in depth-first order, children in the scene's order.
  void write_nodes() {
    std::vector<std::pair<const aiNode*, int>> waiting{{scene_.mRootNode, -1}};
    while (!waiting.empty()) {
      const auto [node, parent] = waiting.back();
      waiting.pop_back();
      const int index = static_cast<int>(nodes_.size());
      if (nodes_.size() >= load::kMostNodes)
        throw load::Refusal(fmt::format("has more than {} nodes", load::kMostNodes), "use a simpler file");
      nodes_.push_back(node);
      node_json_.push_back(node_json(*node));
      if (parent >= 0) node_json_[parent]["children"].push_back(index);
      add_name(*node, index);
      for (unsigned i = node->mNumChildren; i-- > 0;) waiting.emplace_back(node->mChildren[i], index);
    }
  }

  /// The node's name. A COLLADA scene without one gets the file's: importers name the armature after it.
  std::string shown_name(const aiNode& node) const {
    const std::string name = name_of(node.mName);
    if (&node != scene_.mRootNode || !name.starts_with("$ColladaAutoName$")) return name;
    const std::string file = load::utf8_name(path_.stem().string());
    return scene_.mRootNode->FindNode(file.c_str()) == nullptr ? file : name;
  }

  Json node_json(const aiNode& node) {
    const load::Decomposition parts = load::decompose(matrix_of(node.mTransformation));
    constexpr double kNoticeableShear = 0.01;
    if (parts.shear > kNoticeableShear)
      warn(fmt::format("node '{}' shears; the nearest rotation and scale are used", name_of(node.mName)));
    const Vec3& t = parts.local.translation;
    const Quat& r = parts.local.rotation;
    const Vec3& s = parts.local.scale;
    Json json{{"name", shown_name(node)}};
    if (!t.isZero(0.0)) json["translation"] = {t.x(), t.y(), t.z()};
    if (!(r.vec().isZero(0.0))) json["rotation"] = {r.x(), r.y(), r.z(), r.w()};
    if (s != Vec3::Ones()) json["scale"] = {s.x(), s.y(), s.z()};
    return json;
  }

  /// Assimp links bones and channels to nodes by name alone; of nodes with one name, one without a mesh wins.
  void add_name(const aiNode& node, int index) {
    const auto [found, is_new] = node_named_.emplace(node.mName.C_Str(), index);
    if (!is_new && nodes_[found->second]->mNumMeshes > 0 && node.mNumMeshes == 0) found->second = index;
  }
  int node_named(const aiString& name) const {
    const auto found = node_named_.find(name.C_Str());
    return found == node_named_.end() ? -1 : found->second;
  }

  void write_materials() {
    for (unsigned i = 0; i < scene_.mNumMaterials; ++i) {
      const aiMaterial& material = *scene_.mMaterials[i];
      aiColor4D color(1, 1, 1, 1);
      material.Get(AI_MATKEY_COLOR_DIFFUSE, color);
      float opacity = 1.0f;
      material.Get(AI_MATKEY_OPACITY, opacity);
      // Exporters disagree on what 0 means; nobody exports a character that cannot be seen.
      const bool blends = opacity > 0.01f && opacity < 0.99f;
      int two_sided = 0;
      material.Get(AI_MATKEY_TWOSIDED, two_sided);
      const auto unit = [](float v) { return std::isfinite(v) ? std::clamp(v, 0.0f, 1.0f) : 1.0f; };
      Json pbr{{"metallicFactor", 0.0}, {"roughnessFactor", 0.9}};
      const int image = image_of(material);
      if (image >= 0) {
        pbr["baseColorTexture"] = {{"index", image}};
        color = aiColor4D(1, 1, 1, 1);
      }
      pbr["baseColorFactor"] = {unit(color.r), unit(color.g), unit(color.b), blends ? opacity : 1.0f};
      Json json{{"name", name_of(material.GetName())}, {"pbrMetallicRoughness", std::move(pbr)}};
      if (blends) json["alphaMode"] = "BLEND";
      if (two_sided != 0) json["doubleSided"] = true;
      materials_.push_back(std::move(json));
    }
  }

  /// Index of the texture (and image) of the material's diffuse map; -1 when there is none that can be read.
  int image_of(const aiMaterial& material) {
    aiString name;
    if (material.GetTexture(aiTextureType_DIFFUSE, 0, &name) != aiReturn_SUCCESS) return -1;
    const auto [known, is_new] = image_named_.emplace(name.C_Str(), -1);
    if (!is_new) return known->second;
    const std::vector<std::uint8_t> bytes = image_bytes(name);
    const std::string_view head(reinterpret_cast<const char*>(bytes.data()),
                                std::min<std::size_t>(bytes.size(), 4));
    const bool png = head == "\x89PNG";
    if (!png && !head.starts_with("\xFF\xD8\xFF")) {
      warn(fmt::format("texture {} is {}; pictures and .glb show its material '{}' plain",
                       load::quoted(name_of(name)),
                       bytes.empty() ? "not beside the file" : "no PNG or JPEG that can be read",
                       name_of(material.GetName())));
      return -1;
    }
    known->second = static_cast<int>(images_.size());
    images_.push_back(
        {{"bufferView", buffer_.add_view(bytes)}, {"mimeType", png ? "image/png" : "image/jpeg"}});
    textures_.push_back({{"source", known->second}});
    return known->second;
  }

  /// Embedded, or a file of that name in the document's folder.
  std::vector<std::uint8_t> image_bytes(const aiString& name) const {
    constexpr std::size_t kMaxImageBytes = 64u << 20;
    if (const aiTexture* texture = scene_.GetEmbeddedTexture(name.C_Str())) {
      if (texture->mHeight != 0) return {};  // not encoded
      const auto* data = reinterpret_cast<const std::uint8_t*>(texture->pcData);
      return {data, data + texture->mWidth};
    }
    std::string file = name.C_Str();
    std::replace(file.begin(), file.end(), '\\', '/');
    const std::filesystem::path base = std::filesystem::path(file).filename();
    if (base.empty() || base == ".." || base == ".") return {};
    auto bytes = read_file(path_.parent_path() / base, kMaxImageBytes);
    return bytes ? std::move(*bytes) : std::vector<std::uint8_t>{};
  }

  /// The meshes of a node become primitives of one glTF mesh with one skin.
  void write_mesh(int node) {
    SkinBones bones;
    Json primitives = Json::array();
    for (unsigned i = 0; i < nodes_[node]->mNumMeshes; ++i) {
      const aiMesh& mesh = *scene_.mMeshes[nodes_[node]->mMeshes[i]];
      Json primitive = primitive_json(mesh, bones);
      if (!primitive.is_null()) primitives.push_back(std::move(primitive));
    }
    if (primitives.empty()) return;
    node_json_[node]["mesh"] = meshes_.size();
    meshes_.push_back({{"name", name_of(nodes_[node]->mName)}, {"primitives", std::move(primitives)}});
    if (bones.nodes.empty()) return;
    node_json_[node]["skin"] = skins_.size();
    skins_.push_back({{"inverseBindMatrices", buffer_.add(bones.inverse_bind, kFloat, "MAT4", 16, 0, false)},
                      {"joints", bones.nodes}});
  }

  struct SkinBones {
    std::vector<int> nodes;
    std::vector<float> inverse_bind;  // 16 each, by columns
  };

  /// Index of the bone in the skin, added when it is new; -1 for a bone without a node.
  int joint_of(const aiBone& bone, SkinBones& bones) {
    const int node = node_named(bone.mName);
    if (node < 0) return -1;
    const Eigen::Matrix4f offset = matrix_of(bone.mOffsetMatrix).cast<float>();
    for (std::size_t i = 0; i < bones.nodes.size(); ++i)
      if (bones.nodes[i] == node &&
          (Eigen::Map<const Eigen::Matrix4f>(bones.inverse_bind.data() + 16 * i) - offset).norm() <=
              1e-4f * offset.norm())
        return static_cast<int>(i);
    bones.nodes.push_back(node);
    bones.inverse_bind.insert(bones.inverse_bind.end(), offset.data(), offset.data() + 16);
    return static_cast<int>(bones.nodes.size()) - 1;
  }

  /// Null for a mesh without triangles.
  Json primitive_json(const aiMesh& mesh, SkinBones& bones) {
    Vertices vertices;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices == 3)
        vertices.indices.insert(vertices.indices.end(), face.mIndices, face.mIndices + 3);
    }
    const auto last = std::max_element(vertices.indices.begin(), vertices.indices.end());
    if (vertices.indices.empty() || *last >= mesh.mNumVertices) return nullptr;
    vertices.positions = numbers_of<3>(mesh.mVertices, mesh.mNumVertices);
    if (mesh.HasNormals()) vertices.normals = unit_normals(mesh);
    if (mesh.HasTextureCoords(0)) {
      vertices.uvs = numbers_of<2>(mesh.mTextureCoords[0], mesh.mNumVertices);
      for (std::size_t i = 1; i < vertices.uvs.size(); i += 2) vertices.uvs[i] = 1.0f - vertices.uvs[i];
    }
    if (mesh.HasBones()) read_weights(mesh, bones, vertices);
    vertices.merge_equal();
    Json primitive{{"attributes", attributes_json(vertices)},
                   {"indices", buffer_.add(vertices.indices, kUint32, "SCALAR", 1, kElementBuffer, false)}};
    if (mesh.mMaterialIndex < scene_.mNumMaterials) primitive["material"] = mesh.mMaterialIndex;
    return primitive;
  }

  Json attributes_json(const Vertices& vertices) {
    Json attributes{{"POSITION", buffer_.add(vertices.positions, kFloat, "VEC3", 3, kArrayBuffer, true)}};
    const auto add = [&](const char* name, const auto& numbers, int component_type, const char* type,
                         std::size_t width) {
      if (!numbers.empty())
        attributes[name] = buffer_.add(numbers, component_type, type, width, kArrayBuffer, false);
    };
    add("NORMAL", vertices.normals, kFloat, "VEC3", 3);
    add("TEXCOORD_0", vertices.uvs, kFloat, "VEC2", 2);
    add("JOINTS_0", vertices.joints, kUint16, "VEC4", 4);
    add("WEIGHTS_0", vertices.weights, kFloat, "VEC4", 4);
    return attributes;
  }

  template <int Width>
  static std::vector<float> numbers_of(const aiVector3D* vectors, std::size_t count) {
    std::vector<float> numbers;
    numbers.reserve(count * Width);
    for (std::size_t i = 0; i < count; ++i)
      for (unsigned k = 0; k < Width; ++k) numbers.push_back(vectors[i][k]);
    return numbers;
  }

  static std::vector<float> unit_normals(const aiMesh& mesh) {
    std::vector<float> normals = numbers_of<3>(mesh.mNormals, mesh.mNumVertices);
    for (std::size_t i = 0; i < normals.size(); i += 3) {
      Eigen::Map<Eigen::Vector3f> normal(normals.data() + i);
      if (!normal.allFinite() || normal.isZero(0.0f)) normal = Eigen::Vector3f::UnitY();
      normal.normalize();
    }
    return normals;
  }

  struct Influence {
    float weight = 0.0f;
    int joint = 0;
  };

  /// The four strongest influences of every vertex, scaled to a sum of 1.
  void read_weights(const aiMesh& mesh, SkinBones& bones, Vertices& vertices) {
    std::vector<std::vector<Influence>> influences(mesh.mNumVertices);
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      const int joint = joint_of(bone, bones);
      if (joint < 0) warn(fmt::format("bone '{}' has no node and is left out", name_of(bone.mName)));
      for (unsigned w = 0; joint >= 0 && w < bone.mNumWeights; ++w) {
        const aiVertexWeight& weight = bone.mWeights[w];
        if (weight.mVertexId < mesh.mNumVertices && std::isfinite(weight.mWeight) && weight.mWeight > 0.0f)
          influences[weight.mVertexId].push_back({weight.mWeight, joint});
      }
    }
    if (bones.nodes.empty()) return;
    vertices.joints.assign(4 * influences.size(), 0);
    vertices.weights.assign(4 * influences.size(), 0.0f);
    for (std::size_t v = 0; v < influences.size(); ++v) {
      auto& list = influences[v];
      if (list.empty()) list.push_back({1.0f, 0});
      std::stable_sort(list.begin(), list.end(),
                       [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
      list.resize(std::min<std::size_t>(list.size(), 4));
      const float sum = std::accumulate(list.begin(), list.end(), 0.0f,
                                        [](float total, const Influence& i) { return total + i.weight; });
      for (std::size_t k = 0; k < list.size(); ++k) {
        vertices.joints[4 * v + k] = static_cast<std::uint16_t>(list[k].joint);
        vertices.weights[4 * v + k] = list[k].weight / sum;
      }
    }
  }

  void write_animations() {
    for (unsigned i = 0; i < scene_.mNumAnimations; ++i) {
      const aiAnimation& animation = *scene_.mAnimations[i];
      const double rate = animation.mTicksPerSecond > 0.0 ? animation.mTicksPerSecond : 25.0;
      Json samplers = Json::array();
      Json channels = Json::array();
      const double first_tick = first_key(animation);
      for (unsigned c = 0; c < animation.mNumChannels; ++c) {
        const aiNodeAnim& channel = *animation.mChannels[c];
        const int node = node_named(channel.mNodeName);
        if (node < 0) continue;
        const KeyTimes times{first_tick, rate};
        add_channel(channel.mPositionKeys, channel.mNumPositionKeys, times, node, "translation", samplers,
                    channels);
        add_channel(channel.mRotationKeys, channel.mNumRotationKeys, times, node, "rotation", samplers,
                    channels);
        add_channel(channel.mScalingKeys, channel.mNumScalingKeys, times, node, "scale", samplers, channels);
      }
      if (channels.empty()) continue;
      Json json{{"channels", std::move(channels)}, {"samplers", std::move(samplers)}};
      if (animation.mName.length > 0) json["name"] = name_of(animation.mName);
      animations_.push_back(std::move(json));
    }
  }

  /// How many ticks before 0 the animation starts; 0 if it does not. glTF has no negative times.
  static double first_key(const aiAnimation& animation) {
    double first = 0.0;
    const auto include = [&](const auto* keys, unsigned count) {
      for (unsigned k = 0; k < count; ++k)
        if (keys[k].mTime < first) first = keys[k].mTime;
    };
    for (unsigned c = 0; c < animation.mNumChannels; ++c) {
      const aiNodeAnim& channel = *animation.mChannels[c];
      include(channel.mPositionKeys, channel.mNumPositionKeys);
      include(channel.mRotationKeys, channel.mNumRotationKeys);
      include(channel.mScalingKeys, channel.mNumScalingKeys);
    }
    return first;
  }

  struct KeyTimes {
    double first_tick;
    double ticks_per_second;
    double seconds(double tick) const { return (tick - first_tick) / ticks_per_second; }
  };

  static void append(const aiVector3D& v, std::vector<float>& values) {
    values.insert(values.end(), {v.x, v.y, v.z});
  }
  static void append(const aiQuaternion& q, std::vector<float>& values) {
    Eigen::Vector4f r(q.x, q.y, q.z, q.w);
    r.normalize();
    if (values.size() >= 4 &&
        r.dot(Eigen::Map<const Eigen::Vector4f>(values.data() + values.size() - 4)) < 0.0f)
      r = -r;
    values.insert(values.end(), r.begin(), r.end());
  }

  /// Adds a sampler and channel of the keys whose times increase.
  template <typename Key>
  void add_channel(const Key* keys, unsigned count, const KeyTimes& key_times, int node, const char* path,
                   Json& samplers, Json& channels) {
    std::vector<float> times;
    std::vector<float> values;
    for (unsigned k = 0; k < count; ++k) {
      const double seconds = key_times.seconds(keys[k].mTime);
      if (!std::isfinite(seconds)) continue;
      if (!times.empty() && seconds < static_cast<double>(times.back()) + kMinKeyDistance_s) continue;
      times.push_back(static_cast<float>(seconds));
      append(keys[k].mValue, values);
    }
    if (times.empty()) return;
    const std::size_t width = values.size() / times.size();
    const int input = time_accessor(times);
    const int output = buffer_.add(values, kFloat, width == 4 ? "VEC4" : "VEC3", width, 0, false);
    channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers.push_back({{"input", input}, {"output", output}});
  }

  /// Channels with the same times share one accessor.
  int time_accessor(const std::vector<float>& times) {
    const auto [found, is_new] = time_accessors_.emplace(times, -1);
    if (is_new) found->second = buffer_.add(times, kFloat, "SCALAR", 1, 0, true);
    return found->second;
  }

  std::optional<double> metadata_number(const char* key) const {
    std::int32_t integer = 0;
    float single = 0.0f;
    double number = 0.0;
    if (scene_.mMetaData == nullptr) return std::nullopt;
    if (scene_.mMetaData->Get(key, integer)) return integer;
    if (scene_.mMetaData->Get(key, single)) return static_cast<double>(single);
    if (scene_.mMetaData->Get(key, number)) return number;
    return std::nullopt;
  }

  /// Unit and axes: FBX states them in its metadata, and assimp leaves the coordinates as they are; for DAE
  /// assimp puts them into the root node's matrix.
  void read_axes(load::SceneDocument& result) {
    if (load::same_word(path_.extension().string(), ".dae")) {
      result.metres_per_unit = 1.0;
      result.yup_from_file = Quat::Identity();
    }
    if (const auto centimetres = metadata_number("UnitScaleFactor"); centimetres && *centimetres > 0.0)
      result.metres_per_unit = 0.01 * *centimetres;
    Mat3 yup_from_file = Mat3::Zero();
    const std::pair<const char*, int> axes[] = {{"CoordAxis", 0}, {"UpAxis", 1}, {"FrontAxis", 2}};
    for (const auto& [key, row] : axes) {
      const auto axis = metadata_number(key);
      const auto sign = metadata_number((std::string(key) + "Sign").c_str());
      if (!axis || !sign) return;
      if (*axis == 0.0 || *axis == 1.0 || *axis == 2.0)
        yup_from_file(row, static_cast<int>(*axis)) = *sign < 0.0 ? -1.0 : 1.0;
    }
    if (std::abs(yup_from_file.determinant() - 1.0) > 1e-9)
      warn("states axes that are not right-handed; they are taken from its geometry instead");
    else
      result.yup_from_file = Quat(yup_from_file).normalized();
  }

  const aiScene& scene_;
  const std::filesystem::path& path_;
  Diagnostics& diagnostics_;
  BufferWriter buffer_;
  std::vector<const aiNode*> nodes_;
  std::map<std::string, int> node_named_;
  std::map<std::string, int> image_named_;
  std::map<std::vector<float>, int> time_accessors_;
  Json node_json_ = Json::array();
  Json meshes_ = Json::array();
  Json skins_ = Json::array();
  Json materials_ = Json::array();
  Json textures_ = Json::array();
  Json images_ = Json::array();
  Json animations_ = Json::array();
};

/// Removes every importer but the one for `extension`, so that assimp tries no other one on the content.
void keep_only(Assimp::Importer& importer, const Assimp::BaseImporter* kept) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* other = importer.GetImporter(i);
    if (other == kept) continue;
    importer.UnregisterLoader(other);
    delete other;
  }
}

}  // namespace

namespace load {

Result<SceneDocument> document_from_scene(std::span<const std::uint8_t> bytes,
                                          const std::filesystem::path& path, Diagnostics& diagnostics) {
  const std::string extension = path.extension().string();
  if (extension.size() < 2) return input_error(path, "has no extension", kKnownExtensions);
  const std::string hint = extension.substr(1);
  Assimp::Importer importer;
  const Assimp::BaseImporter* reader = importer.GetImporter(hint.c_str());
  if (reader == nullptr)
    return input_error(path, fmt::format("extension {} is not known", load::quoted(extension)),
                       kKnownExtensions);
  keep_only(importer, reader);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_REMOVE_EMPTY_BONES, false);
  const aiScene* scene =
      importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_Triangulate, hint.c_str());
  if (scene == nullptr || scene->mRootNode == nullptr)
    return input_error(path, fmt::format("cannot be read: {}", importer.GetErrorString()),
                       "export the file again, or export it as .glb");
  return SceneConverter(*scene, path, diagnostics).convert();
}

}  // namespace load
}  // namespace ukemi
