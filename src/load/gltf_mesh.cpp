#include "load/gltf_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "load/gltf_container.h"
#include "load/gltf_draco.h"
#include "load/text.h"

namespace ukemi::load {
namespace {

constexpr int kTriangles = 4;
constexpr int kTriangleStrip = 5;
constexpr int kTriangleFan = 6;

std::string mime_of(const std::vector<std::uint8_t>& bytes, const std::string& stated) {
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()),
                              std::min<std::size_t>(bytes.size(), 12));
  if (head.starts_with("\x89PNG")) return "image/png";
  if (head.starts_with("\xFF\xD8\xFF")) return "image/jpeg";
  if (head.starts_with("RIFF") && head.substr(8) == "WEBP") return "image/webp";
  return stated;
}

/// The image of textures[i]; -1 when it names none. WebP and Basis images are named in extensions.
int image_of(const JsonView& texture, std::size_t image_count) {
  const int image = texture.index("source", image_count, "images");
  const auto extensions = texture.find("extensions");
  if (image >= 0 || !extensions) return image;
  for (const char* name : {"EXT_texture_webp", "KHR_texture_basisu"})
    if (const auto extension = extensions->find(name))
      return extension->index("source", image_count, "images");
  return -1;
}

class MaterialReader {
 public:
  MaterialReader(const JsonView& root, std::size_t image_count)
      : textures_(root.items("textures")), image_count_(image_count) {
    for (const JsonView& texture : textures_) image_of(texture, image_count_);
  }

  TexturedMaterial read(const JsonView& json) const {
    TexturedMaterial result;
    Material& material = result.material;
    material.name = json.text("name", "");
    material.double_sided = json.boolean("doubleSided", false);
    material.alpha = alpha_of(json);
    material.alpha_cutoff = static_cast<float>(json.number("alphaCutoff", 0.5));
    if (const auto pbr = json.find("pbrMetallicRoughness")) {
      material.base_color = color(*pbr, "baseColorFactor");
      read_texture(*pbr, "baseColorTexture", result);
      check_texture(*pbr, "metallicRoughnessTexture");
    }
    const auto extensions = json.find("extensions");
    if (const auto glossy =
            extensions ? extensions->find("KHR_materials_pbrSpecularGlossiness") : std::nullopt) {
      material.base_color = color(*glossy, "diffuseFactor");
      read_texture(*glossy, "diffuseTexture", result);
    }
    for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"}) check_texture(json, key);
    return result;
  }

 private:
  static Material::Alpha alpha_of(const JsonView& json) {
    const std::string mode = json.text("alphaMode", "OPAQUE");
    if (mode == "OPAQUE") return Material::Alpha::opaque;
    if (mode == "MASK") return Material::Alpha::mask;
    if (mode == "BLEND") return Material::Alpha::blend;
    json.refuse(fmt::format("has alphaMode \"{}\", which is not known", mode));
  }
  static std::array<float, 4> color(const JsonView& json, const char* key) {
    std::array<float, 4> result{};
    const std::vector<double> numbers = json.numbers(key, {1, 1, 1, 1});
    std::transform(numbers.begin(), numbers.end(), result.begin(),
                   [](double v) { return static_cast<float>(v); });
    return result;
  }
  int check_texture(const JsonView& json, const char* key) const {
    const auto info = json.find(key);
    if (!info) return -1;
    info->number("scale", 1.0);
    info->number("strength", 1.0);
    info->integer("texCoord", 0, 15, 0);
    return info->at("index").index(textures_.size(), "textures");
  }
  void read_texture(const JsonView& json, const char* key, TexturedMaterial& result) const {
    const int texture = check_texture(json, key);
    if (texture < 0) return;
    result.material.base_color_image = image_of(textures_[texture], image_count_);
    const JsonView info = json.at(key);
    result.uv_set = static_cast<int>(info.integer("texCoord", 0, 15, 0));
    const auto extensions = info.find("extensions");
    const auto transform = extensions ? extensions->find("KHR_texture_transform") : std::nullopt;
    if (!transform) return;
    result.uv_set = static_cast<int>(transform->integer("texCoord", 0, 15, result.uv_set));
    const auto offset = transform->numbers("offset", {0, 0});
    const auto scale = transform->numbers("scale", {1, 1});
    // The extension's matrix is translation * rotation * scale with the rotation clockwise in (u, v).
    result.uv_transform = Eigen::Translation2f(static_cast<float>(offset[0]), static_cast<float>(offset[1])) *
                          Eigen::Rotation2Df(-static_cast<float>(transform->number("rotation", 0.0))) *
                          Eigen::Scaling(static_cast<float>(scale[0]), static_cast<float>(scale[1]));
  }

  std::vector<JsonView> textures_;
  std::size_t image_count_;
};

/// Vertex attributes and indices of one primitive, compressed or not.
class PrimitiveReader {
 public:
  PrimitiveReader(const JsonView& primitive, const PrimitiveUse& use, Accessors& accessors)
      : primitive_(primitive), attributes_(primitive.at("attributes")), use_(use), accessors_(accessors) {
    const auto extensions = primitive.find("extensions");
    if (const auto draco = extensions ? extensions->find("KHR_draco_mesh_compression") : std::nullopt)
      draco_ = decode_draco(*draco, primitive, accessors);
  }

  MeshPart read(const std::vector<TexturedMaterial>& materials) {
    MeshPart part;
    part.node = use_.node;
    part.material = primitive_.index("material", materials.size(), "materials");
    if (!attributes_.find("POSITION")) return part;
    assign(part.positions, values("POSITION", 3));
    vertex_count_ = part.positions.size();
    read_indices(part);
    if (attributes_.find("NORMAL")) assign(part.normals, values("NORMAL", 3));
    apply_morphs(part);
    if (part.normals.empty() && !part.indices.empty()) compute_normals(part);
    for (auto& normal : part.normals) normal.normalize();
    read_uvs(part, part.material < 0 ? TexturedMaterial{} : materials[part.material]);
    read_colors(part);
    if (attributes_.find("JOINTS_0") && attributes_.find("WEIGHTS_0") && use_.skin >= 0) read_weights(part);
    return part;
  }

 private:
  template <typename Vector>
  static void assign(std::vector<Vector>& out, const std::vector<float>& numbers) {
    constexpr std::size_t kWidth = Vector::RowsAtCompileTime;
    out.resize(numbers.size() / kWidth);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = Eigen::Map<const Vector>(numbers.data() + i * kWidth);
  }

  int accessor_of(const JsonView& parent, const std::string& name) const {
    return parent.at(name.c_str()).index(accessors_.size(), "accessors");
  }
  void check_count(const JsonView& place, std::size_t count) const {
    if (count != vertex_count_)
      place.refuse(fmt::format("has {} vertices, but POSITION has {}", count, vertex_count_));
  }

  std::vector<float> values(const std::string& name, int components) {
    const int accessor = accessor_of(attributes_, name);
    std::vector<float> numbers;
    if (draco_ && draco_->attributes.contains(name)) {
      if (accessors_.components(accessor) != components)
        attributes_.at(name.c_str()).refuse(fmt::format("does not have {} components", components));
      numbers = draco_->attributes.at(name);
    } else {
      numbers = accessors_.floats(accessor, components);
    }
    if (name != "POSITION")
      check_count(attributes_.at(name.c_str()), numbers.size() / static_cast<std::size_t>(components));
    return numbers;
  }

  void read_indices(MeshPart& part) {
    const auto mode = primitive_.integer("mode", 0, 6, kTriangles);
    std::vector<std::uint32_t> indices;
    if (draco_) {
      indices = draco_->indices;
    } else if (primitive_.find("indices")) {
      indices = accessors_.unsigned_integers(accessor_of(primitive_, "indices"), 1);
    } else {
      indices.resize(vertex_count_);
      for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint32_t>(i);
    }
    for (std::size_t i = 0; i < indices.size(); ++i)
      if (indices[i] >= vertex_count_)
        primitive_.refuse(
            fmt::format("has index {} = {}, but there are {} vertices", i, indices[i], vertex_count_));
    if (mode < kTriangles) return;
    if (mode == kTriangles || draco_) {
      if (indices.size() % 3 != 0)
        primitive_.refuse(fmt::format("has {} indices, which is no multiple of 3", indices.size()));
      part.indices = std::move(indices);
      return;
    }
    for (std::size_t i = 2; i < indices.size(); ++i) {
      const std::size_t odd = mode == kTriangleStrip ? i % 2 : 0;
      const std::uint32_t first = mode == kTriangleFan ? indices[0] : indices[i - 2 + odd];
      const std::uint32_t second = mode == kTriangleFan ? indices[i - 1] : indices[i - 1 - odd];
      part.indices.insert(part.indices.end(), {first, second, indices[i]});
    }
  }

  void apply_morphs(MeshPart& part) {
    const std::vector<JsonView> targets = primitive_.items("targets");
    for (std::size_t t = 0; t < targets.size(); ++t) {
      for (const auto& [name, view] : targets[t].members()) view.index(accessors_.size(), "accessors");
      const double weight = t < use_.morph_weights.size() ? use_.morph_weights[t] : 0.0;
      if (weight == 0.0) continue;
      add_morph(targets[t], "POSITION", static_cast<float>(weight), part.positions);
      if (!part.normals.empty()) add_morph(targets[t], "NORMAL", static_cast<float>(weight), part.normals);
    }
  }

  void add_morph(const JsonView& target, const char* name, float weight,
                 std::vector<Eigen::Vector3f>& vertices) {
    if (!target.find(name)) return;
    const std::vector<float> offsets = accessors_.floats(accessor_of(target, name), 3);
    check_count(target.at(name), offsets.size() / 3);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      vertices[i] += weight * Eigen::Map<const Eigen::Vector3f>(offsets.data() + 3 * i);
  }

  /// Smooth normals, faces weighted by their area.
  static void compute_normals(MeshPart& part) {
    part.normals.assign(part.positions.size(), Eigen::Vector3f::Zero());
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
      const std::uint32_t* triangle = part.indices.data() + i;
      const Eigen::Vector3f& a = part.positions[triangle[0]];
      const Eigen::Vector3f normal = (part.positions[triangle[1]] - a).cross(part.positions[triangle[2]] - a);
      for (int corner = 0; corner < 3; ++corner) part.normals[triangle[corner]] += normal;
    }
  }

  void read_uvs(MeshPart& part, const TexturedMaterial& material) {
    std::string name = fmt::format("TEXCOORD_{}", material.uv_set);
    if (!attributes_.find(name.c_str())) name = "TEXCOORD_0";
    if (!attributes_.find(name.c_str())) return;
    assign(part.uvs, values(name, 2));
    for (auto& uv : part.uvs) uv = material.uv_transform * uv;
  }

  void read_colors(MeshPart& part) {
    if (!attributes_.find("COLOR_0")) return;
    const int components = accessors_.components(accessor_of(attributes_, "COLOR_0"));
    if (components != 3 && components != 4)
      attributes_.at("COLOR_0").refuse("has neither 3 nor 4 components");
    const std::vector<float> numbers = values("COLOR_0", components);
    part.colors.assign(vertex_count_, {1, 1, 1, 1});
    for (std::size_t i = 0; i < vertex_count_; ++i)
      std::copy_n(numbers.data() + i * static_cast<std::size_t>(components), components,
                  part.colors[i].begin());
  }

  std::vector<std::uint32_t> joints(const std::string& name) {
    if (!draco_ || !draco_->attributes.contains(name)) {
      auto numbers = accessors_.unsigned_integers(accessor_of(attributes_, name), 4);
      check_count(attributes_.at(name.c_str()), numbers.size() / 4);
      return numbers;
    }
    const std::vector<float> numbers = values(name, 4);
    std::vector<std::uint32_t> result(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
      result[i] =
          numbers[i] < 0.0f || numbers[i] > 65535.0f ? 65536u : static_cast<std::uint32_t>(numbers[i]);
    return result;
  }

  struct Influence {
    float weight = 0.0f;
    std::uint32_t joint = 0;
  };

  void read_weights(MeshPart& part) {
    std::vector<std::vector<Influence>> influences(vertex_count_);
    for (int set = 0; set < 4; ++set) {
      const std::string joint_name = fmt::format("JOINTS_{}", set);
      const std::string weight_name = fmt::format("WEIGHTS_{}", set);
      if (!attributes_.find(joint_name.c_str()) || !attributes_.find(weight_name.c_str())) break;
      const std::vector<std::uint32_t> indices = joints(joint_name);
      const std::vector<float> weights = values(weight_name, 4);
      for (std::size_t i = 0; i < weights.size(); ++i)
        add_influence(influences[i / 4], weights[i], indices[i], i / 4);
    }
    part.skin = use_.skin;
    part.joints.resize(vertex_count_);
    part.weights.resize(vertex_count_);
    for (std::size_t v = 0; v < vertex_count_; ++v)
      keep_strongest(influences[v], part.joints[v], part.weights[v]);
  }

  void add_influence(std::vector<Influence>& influences, float weight, std::uint32_t joint,
                     std::size_t vertex) const {
    constexpr float kRounding = 1e-3f;
    if (weight < -kRounding)
      attributes_.refuse(fmt::format("gives vertex {} the negative weight {}", vertex, weight));
    if (weight <= 0.0f) return;
    if (joint >= use_.joint_count)
      attributes_.refuse(fmt::format("binds vertex {} to joint {}, but skins[{}] has {} joints", vertex,
                                     joint, use_.skin, use_.joint_count));
    influences.push_back({weight, joint});
  }

  /// The four strongest, scaled to a sum of 1; a vertex without weights follows the skin's first joint.
  static void keep_strongest(std::vector<Influence>& influences, std::array<std::uint16_t, 4>& joints,
                             std::array<float, 4>& weights) {
    if (influences.empty()) influences.push_back({1.0f, 0});
    if (influences.size() > 4) {
      std::stable_sort(influences.begin(), influences.end(),
                       [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
      influences.resize(4);
    }
    double sum = 0.0;
    for (const Influence& influence : influences) sum += static_cast<double>(influence.weight);
    joints.fill(0);
    weights.fill(0.0f);
    for (std::size_t k = 0; k < influences.size(); ++k) {
      joints[k] = static_cast<std::uint16_t>(influences[k].joint);
      weights[k] = static_cast<float>(static_cast<double>(influences[k].weight) / sum);
    }
  }

  const JsonView& primitive_;
  JsonView attributes_;
  const PrimitiveUse& use_;
  Accessors& accessors_;
  std::optional<DracoMesh> draco_;
  std::size_t vertex_count_ = 0;
};

}  // namespace

std::vector<Image> read_images(const JsonView& root, Accessors& accessors,
                               const std::filesystem::path& folder, const std::filesystem::path& path,
                               Diagnostics& diagnostics) {
  std::vector<Image> images;
  for (const JsonView& json : root.items("images")) {
    Image image;
    const int view = json.index("bufferView", accessors.view_count(), "bufferViews");
    if (view >= 0) {
      const auto bytes = accessors.view_bytes(view);
      image.bytes.assign(bytes.begin(), bytes.end());
    } else if (const auto uri = json.find("uri")) {
      if (auto bytes = resolve_uri(*uri, folder))
        image.bytes = std::move(*bytes);
      else
        diagnostics.warn(path.string(),
                         fmt::format("{}: its file {} cannot be read; pictures show its material plain",
                                     json.place(), load::quoted(uri->text())));
    } else {
      json.refuse("has neither a uri nor a bufferView");
    }
    accessors.budget().spend(image.bytes.size(), json.place());
    image.mime = mime_of(image.bytes, json.text("mimeType", ""));
    images.push_back(std::move(image));
  }
  return images;
}

std::vector<TexturedMaterial> read_materials(const JsonView& root, std::size_t image_count) {
  const MaterialReader reader(root, image_count);
  std::vector<TexturedMaterial> materials;
  for (const JsonView& json : root.items("materials")) materials.push_back(reader.read(json));
  return materials;
}

MeshPart read_primitive(const JsonView& primitive, const PrimitiveUse& use,
                        const std::vector<TexturedMaterial>& materials, Accessors& accessors) {
  return PrimitiveReader(primitive, use, accessors).read(materials);
}

}  // namespace ukemi::load
