// glTF 2.0 (.gltf, .glb, .vrm, .vrma), read from its JSON document.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <set>

#include "base/errors.h"
#include "load/gltf_accessors.h"
#include "load/gltf_container.h"
#include "load/gltf_mesh.h"
#include "load/gltf_reader.h"
#include "load/json_view.h"
#include "load/load.h"
#include "load/text.h"

namespace ukemi {
namespace {

using load::Accessors;
using load::JsonView;
using load::Refusal;

constexpr const char* kExportAgain = "export the file again";
// Most vertices of all instances together, so that a small file cannot ask for gigabytes.
constexpr std::size_t kMaxVertices = std::size_t{1} << 25;
constexpr int kMaxDepth = 1000;  // of the nodes
constexpr float kLongest_s = 86400.0f;

bool is_supported(const std::string& extension) {
  static const std::set<std::string> kSupported{
      "KHR_mesh_quantization", "KHR_draco_mesh_compression", "EXT_meshopt_compression",
      "KHR_texture_transform", "EXT_texture_webp",           "KHR_texture_basisu",
      "KHR_lights_punctual",   "KHR_animation_pointer",      "VRM"};
  return kSupported.contains(extension) || extension.starts_with("KHR_materials_") ||
         extension.starts_with("VRMC_");
}

LocalTransform read_transform(const JsonView& node) {
  if (node.find("matrix")) {
    const std::vector<double> numbers = node.numbers("matrix", std::vector<double>(16, 0.0));
    const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix4d>(numbers.data());
    constexpr double kLargestShear = 0.01;
    const bool affine = (matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() < 1e-6;
    const load::Decomposition parts = load::decompose(matrix);
    if (!affine || parts.shear > kLargestShear)
      node.at("matrix").refuse("is no translation, rotation and scale");
    return parts.local;
  }
  LocalTransform local;
  local.translation = Vec3(node.numbers("translation", {0, 0, 0}).data());
  local.scale = Vec3(node.numbers("scale", {1, 1, 1}).data());
  local.rotation = Quat(node.numbers("rotation", {0, 0, 0, 1}).data());
  constexpr double kLargestDeviation = 0.1;
  if (std::abs(local.rotation.norm() - 1.0) > kLargestDeviation)
    node.at("rotation").refuse(fmt::format("has length {:.3g}, not 1", local.rotation.norm()));
  local.rotation.normalize();
  return local;
}

class GltfReader {
 public:
  GltfReader(const std::filesystem::path& path, Diagnostics& diagnostics)
      : path_(path), diagnostics_(diagnostics) {}

  Character read(load::GltfContainer container) {
    if (container.bytes_after_end > 0)
      diagnostics_.warn(path_.string(), fmt::format("has {} bytes after its announced end; they are left out",
                                                    container.bytes_after_end));
    container.document.folder = path_.parent_path();
    const load::JsonDocument document(text_of(container.document));
    const JsonView root = document.root();
    check_asset(root);
    load::MemoryBudget budget;
    load::resolve_buffers(root, container, budget);
    Accessors accessors(root, container.document.buffers, budget);
    read_nodes(root);
    read_skins(root, accessors);
    character_.images = load::read_images(root, accessors, container.document.folder, path_, diagnostics_);
    read_meshes(root, accessors);
    read_animations(root, accessors);
    read_vrm_bones(root);
    character_.name = path_.stem().string();
    character_.path = path_;
    character_.format = SourceFormat::gltf;
    character_.document = std::move(container.document);
    return std::move(character_);
  }

 private:
  static std::string_view text_of(const GltfDocument& document) {
    const std::string_view text = document.json;
    return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
  }

  void check_asset(const JsonView& root) const {
    const std::string version = root.at("asset").at("version").text();
    if (!version.starts_with("2."))
      throw Refusal(fmt::format("asset.version is {}, but 2.0 is needed", load::quoted(version)),
                    "export it as glTF 2.0");
    for (const JsonView& extension : root.items("extensionsRequired"))
      if (!is_supported(extension.text()))
        throw Refusal(fmt::format("{} is {}, which is not supported", extension.place(),
                                  load::quoted(extension.text())),
                      "export the file without this extension");
  }

  void read_nodes(const JsonView& root) {
    nodes_ = root.items("nodes");
    Skeleton& skeleton = character_.skeleton;
    if (nodes_.empty()) throw Refusal("has no nodes", "use a file with a character in it");
    if (nodes_.size() > load::kMostNodes)
      throw Refusal(fmt::format("has {} nodes; the limit is {}", nodes_.size(), load::kMostNodes),
                    "use a simpler file");
    skeleton.nodes.resize(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      skeleton.nodes[i].name = nodes_[i].text("name", "");
      skeleton.nodes[i].rest = read_transform(nodes_[i]);
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      for (const JsonView& child : nodes_[i].items("children")) {
        Node& node = skeleton.nodes[child.index(nodes_.size(), "nodes")];
        if (node.parent >= 0) child.refuse(fmt::format("is a child of nodes[{}] already", node.parent));
        node.parent = static_cast<int>(i);
      }
    if (!skeleton.sort()) throw Refusal("nodes: a node is its own ancestor", kExportAgain);
    check_depth();
    read_scenes(root);
  }

  /// Refuses deeper trees, so that walks towards the root stay short.
  void check_depth() const {
    std::vector<int> depth(nodes_.size(), 1);
    for (const int node : character_.skeleton.order) {
      const int parent = character_.skeleton.nodes[node].parent;
      if (parent >= 0) depth[node] = depth[parent] + 1;
      if (depth[node] > kMaxDepth) nodes_[node].refuse(fmt::format("is nested deeper than {}", kMaxDepth));
    }
  }

  /// Marks the nodes of the default scene; all of them when there are no scenes.
  void read_scenes(const JsonView& root) {
    const std::vector<JsonView> scenes = root.items("scenes");
    const int chosen = root.index("scene", scenes.size(), "scenes");
    in_scene_.assign(nodes_.size(), scenes.empty());
    for (std::size_t s = 0; s < scenes.size(); ++s)
      for (const JsonView& item : scenes[s].items("nodes")) {
        const int node = item.index(nodes_.size(), "nodes");
        if (static_cast<int>(s) == std::max(chosen, 0)) in_scene_[node] = true;
      }
    for (const int node : character_.skeleton.order) {
      const int parent = character_.skeleton.nodes[node].parent;
      if (parent >= 0 && in_scene_[parent]) in_scene_[node] = true;
    }
  }

  void read_skins(const JsonView& root, Accessors& accessors) {
    for (const JsonView& json : root.items("skins")) {
      Skin skin;
      for (const JsonView& joint : json.at("joints").items())
        skin.joints.push_back(joint.index(nodes_.size(), "nodes"));
      if (skin.joints.empty() || skin.joints.size() > 65535)
        json.at("joints").refuse(fmt::format("has {} joints", skin.joints.size()));
      accessors.budget().spend(skin.joints.size() * sizeof(Affine), json.place());
      json.index("skeleton", nodes_.size(), "nodes");
      skin.inverse_bind.assign(skin.joints.size(), Affine::Identity());
      const int accessor = json.index("inverseBindMatrices", accessors.size(), "accessors");
      if (accessor >= 0) {
        if (accessors.count(accessor) < skin.joints.size())
          json.refuse(fmt::format("has {} joints, but {} has {} matrices", skin.joints.size(),
                                  accessors.place(accessor), accessors.count(accessor)));
        const std::vector<float> numbers = accessors.floats(accessor, 16);
        for (std::size_t i = 0; i < skin.joints.size(); ++i)
          skin.inverse_bind[i].affine() =
              Eigen::Map<const Eigen::Matrix4f>(numbers.data() + 16 * i).cast<double>().topRows<3>();
      }
      character_.skins.push_back(std::move(skin));
    }
  }

  void read_meshes(const JsonView& root, Accessors& accessors) {
    const std::vector<JsonView> meshes = root.items("meshes");
    const auto materials = load::read_materials(root, character_.images.size());
    for (const auto& m : materials) character_.materials.push_back(m.material);
    std::size_t vertices = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const int mesh = nodes_[i].index("mesh", meshes.size(), "meshes");
      const int skin = nodes_[i].index("skin", character_.skins.size(), "skins");
      if (mesh < 0 || !in_scene_[i]) continue;
      const load::PrimitiveUse use{static_cast<int>(i), skin,
                                   skin < 0 ? 0 : character_.skins[skin].joints.size(),
                                   morph_weights(nodes_[i], meshes[mesh])};
      for (const JsonView& primitive : meshes[mesh].at("primitives").items()) {
        MeshPart part = load::read_primitive(primitive, use, materials, accessors);
        vertices += part.positions.size();
        if (vertices > kMaxVertices)
          throw Refusal(fmt::format("nodes instance more than {} vertices", kMaxVertices),
                        "use a simpler mesh");
        if (!part.indices.empty()) character_.parts.push_back(std::move(part));
      }
    }
  }

  static std::vector<double> morph_weights(const JsonView& node, const JsonView& mesh) {
    std::vector<double> weights;
    for (const JsonView& weight : node.find("weights") ? node.items("weights") : mesh.items("weights"))
      weights.push_back(weight.number());
    return weights;
  }

  void read_animations(const JsonView& root, Accessors& accessors) {
    for (const JsonView& json : root.items("animations")) {
      Animation animation;
      animation.name = json.text("name", fmt::format("animation_{}", character_.animations.size()));
      const std::vector<JsonView> samplers = json.at("samplers").items();
      std::set<std::pair<int, TrackPath>> seen;
      for (const JsonView& channel : json.at("channels").items()) {
        auto track = read_channel(channel, samplers, accessors);
        if (!track) continue;
        if (!seen.insert({track->node, track->path}).second)
          channel.refuse(
              fmt::format("moves the same property of nodes[{}] as an earlier channel", track->node));
        animation.tracks.push_back(std::move(*track));
      }
      for (std::size_t i = 0; i < animation.tracks.size(); ++i) {
        const Track& track = animation.tracks[i];
        animation.start_s = i == 0 ? track.times.front() : std::min(animation.start_s, track.times.front());
        animation.end_s = i == 0 ? track.times.back() : std::max(animation.end_s, track.times.back());
      }
      if (const auto extras = json.find("extras")) animation.extras_json = extras->dump();
      character_.animations.push_back(std::move(animation));
    }
  }

  /// The track of a channel; nothing where it is empty or moves no node (morph weights, pointers).
  std::optional<Track> read_channel(const JsonView& channel, const std::vector<JsonView>& samplers,
                                    Accessors& accessors) const {
    const JsonView target = channel.at("target");
    const JsonView& sampler =
        samplers[channel.at("sampler").index(samplers.size(), "samplers of this animation")];
    Track track;
    track.node = target.index("node", nodes_.size(), "nodes");
    const std::string path = target.at("path").text();
    if (path == "translation")
      track.path = TrackPath::translation;
    else if (path == "rotation")
      track.path = TrackPath::rotation;
    else if (path == "scale")
      track.path = TrackPath::scale;
    else if (path == "weights" || path == "pointer")
      return std::nullopt;
    else
      target.at("path").refuse(fmt::format("is {}, which is no path", load::quoted(path)));
    if (track.node < 0) return std::nullopt;
    track.interpolation = interpolation_of(sampler);
    read_keys(sampler, accessors, track);
    if (track.times.empty()) return std::nullopt;
    return track;
  }

  static Interpolation interpolation_of(const JsonView& sampler) {
    const std::string text = sampler.text("interpolation", "LINEAR");
    if (text == "LINEAR") return Interpolation::linear;
    if (text == "STEP") return Interpolation::step;
    if (text == "CUBICSPLINE") return Interpolation::cubic;
    sampler.at("interpolation").refuse(fmt::format("is {}, which is not known", load::quoted(text)));
  }

  static void read_keys(const JsonView& sampler, Accessors& accessors, Track& track) {
    const int input = sampler.at("input").index(accessors.size(), "accessors");
    const int output = sampler.at("output").index(accessors.size(), "accessors");
    const std::vector<float> times = accessors.floats(input, 1);
    for (std::size_t k = 0; k < times.size(); ++k)
      if (times[k] < 0.0f || (k > 0 && times[k] <= times[k - 1]))
        sampler.at("input").refuse(
            fmt::format("({}): time {} is {} s, which is negative or not after the one before",
                        accessors.place(input), k, times[k]));
    if (!times.empty() && times.back() > kLongest_s)
      sampler.at("input").refuse(
          fmt::format("({}): the last time is {} s, later than a day", accessors.place(input), times.back()));
    const bool cubic = track.interpolation == Interpolation::cubic;
    const std::size_t needed = times.size() * (cubic ? 3 : 1);
    if (accessors.count(output) != needed)
      sampler.at("output").refuse(fmt::format("({}) has {} elements, but {} are needed for {} keys",
                                              accessors.place(output), accessors.count(output), needed,
                                              times.size()));
    if (cubic && times.size() == 1) sampler.at("input").refuse("has one key, but CUBICSPLINE needs two");
    const std::vector<float> values = accessors.floats(output, track.path == TrackPath::rotation ? 4 : 3);
    accessors.budget().spend((times.size() + values.size()) * sizeof(double), accessors.place(output));
    track.times.assign(times.begin(), times.end());
    track.values.assign(values.begin(), values.end());
  }

  void read_vrm_bones(const JsonView& root) {
    const auto extensions = root.find("extensions");
    if (!extensions) return;
    for (const char* name : {"VRM", "VRMC_vrm", "VRMC_vrm_animation"}) {
      const auto extension = extensions->find(name);
      const auto humanoid = extension ? extension->find("humanoid") : std::nullopt;
      const auto bones = humanoid ? humanoid->find("humanBones") : std::nullopt;
      if (!bones) continue;
      if (bones->is_array())
        for (const JsonView& bone : bones->items()) add_vrm_bone(bone.text("bone", ""), bone);
      else
        for (const auto& [bone_name, bone] : bones->members()) add_vrm_bone(bone_name, bone);
    }
  }

  /// VRM 0.x writes node -1 for a bone that is not there.
  void add_vrm_bone(const std::string& name, const JsonView& bone) {
    const auto node = bone.find("node");
    if (name.empty() || !node || node->number() < 0.0) return;
    character_.vrm_bones.emplace_back(name, node->index(nodes_.size(), "nodes"));
  }

  const std::filesystem::path& path_;
  Diagnostics& diagnostics_;
  Character character_;
  std::vector<JsonView> nodes_;
  std::vector<bool> in_scene_;
};

/// Runs `read`, whose refusals become Errors about the file.
template <typename Read>
Result<Character> with_errors(const std::filesystem::path& path, const Read& read) {
  try {
    return read();
  } catch (const Refusal& refusal) {
    return error_at(refusal, input_error(path, refusal.message, refusal.fix));
  } catch (const std::bad_alloc&) {
    return input_error(path, "needs more memory than there is", "use a smaller file");
  }
}

}  // namespace

namespace load {

Decomposition decompose(const Eigen::Matrix4d& matrix) {
  Decomposition parts;
  LocalTransform& local = parts.local;
  local.translation = matrix.block<3, 1>(0, 3);
  Mat3 linear = matrix.block<3, 3>(0, 0);
  local.scale = linear.colwise().norm();
  if (local.scale.isZero(0.0)) return parts;
  for (int axis = 0; axis < 3; ++axis)
    if (local.scale[axis] > 0.0) linear.col(axis) /= local.scale[axis];
  for (int axis = 0; axis < 3; ++axis)
    if (local.scale[axis] == 0.0)
      linear.col(axis) = linear.col((axis + 1) % 3).cross(linear.col((axis + 2) % 3));
  if (linear.determinant() < 0.0) {
    local.scale.x() = -local.scale.x();
    linear.col(0) = -linear.col(0);
  }
  parts.shear = (linear.transpose() * linear - Mat3::Identity()).cwiseAbs().maxCoeff();
  local.rotation = rotation_part(linear);
  return parts;
}

Result<Character> read_container(GltfContainer container, const std::filesystem::path& path,
                                 Diagnostics& diagnostics) {
  return with_errors(path, [&] { return GltfReader(path, diagnostics).read(std::move(container)); });
}

}  // namespace load

Result<Character> read_gltf(std::span<const std::uint8_t> bytes, const std::filesystem::path& path,
                            Diagnostics& diagnostics) {
  auto character =
      with_errors(path, [&] { return GltfReader(path, diagnostics).read(load::split_container(bytes)); });
  if (character) load::restore_additive(*character);
  return character;
}

}  // namespace ukemi
