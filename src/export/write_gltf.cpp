// The character's glTF document, edited in place: what is added goes to the end of its arrays and of its last
// binary, everything else stays as it is.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/errors.h"
#include "base/files.h"
#include "export/container.h"
#include "export/export.h"
#include "export/stick_mesh.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Bytes = std::vector<std::uint8_t>;

constexpr int kFloat = 5126;
constexpr int kShort = 5122;
constexpr int kUnsignedShort = 5123;
constexpr int kArrayBuffer = 34962;
constexpr std::size_t kMaxImageBytes = 512u << 20;

/// The document and the buffer that takes what is added.
struct Edit {
  Json json;
  std::size_t buffer = 0;
  Bytes bin;
};

Error document_error(const Character& character, std::string what, std::string fix) {
  return input_error(character.path, std::move(what), std::move(fix));
}

Json& array_of(Json& object, const char* key) {
  Json& value = object[key];
  if (!value.is_array()) value = Json::array();
  return value;
}

std::size_t aligned_end(Bytes& bytes) {
  bytes.resize((bytes.size() + 3) / 4 * 4);
  return bytes.size();
}

std::size_t append(Json& array, Json value) {
  array.push_back(std::move(value));
  return array.size() - 1;
}

std::size_t add_view(Edit& edit, const void* data, std::size_t size) {
  const std::size_t offset = aligned_end(edit.bin);
  const auto* first = static_cast<const std::uint8_t*>(data);
  edit.bin.insert(edit.bin.end(), first, first + size);
  return append(array_of(edit.json, "bufferViews"),
                {{"buffer", edit.buffer}, {"byteOffset", offset}, {"byteLength", size}});
}

template <typename T>
std::size_t add_view(Edit& edit, const std::vector<T>& values) {
  return add_view(edit, values.data(), values.size() * sizeof(T));
}

/// `offset` in bytes from the start of the view.
std::size_t add_accessor(Edit& edit, std::size_t view, std::size_t offset, int component, std::size_t count,
                         const char* type) {
  return append(array_of(edit.json, "accessors"), {{"bufferView", view},
                                                   {"byteOffset", offset},
                                                   {"componentType", component},
                                                   {"count", count},
                                                   {"type", type}});
}

// ---- buffers and images
// ---------------------------------------------------------------------------------------

bool is_external(const Json& object) {
  const auto uri = object.find("uri");
  return uri != object.end() && uri->is_string() && !uri->get_ref<const std::string&>().starts_with("data:");
}

bool same_folder(const fs::path& a, const std::optional<fs::path>& b) {
  if (!b) return false;
  std::error_code error;
  const auto full = [&](const fs::path& path) {
    return fs::weakly_canonical(path.empty() ? "." : path, error);
  };
  return full(a) == full(*b);
}

/// What an image's URI stands for; empty for other schemes and absolute paths, which stay links.
Result<Bytes> content_of(const std::string& uri, const fs::path& folder) {
  if (auto data = data_of(uri)) return std::move(*data);
  const auto path = local_file(uri, folder);
  if (!path) return Bytes{};
  return read_file(*path, kMaxImageBytes);
}

/// Images in files of their own become data URIs; with `into_binary`, they and data URIs go into the binary.
Status embed_images(Edit& edit, const Character& character, bool into_binary) {
  if (into_binary) array_of(edit.json, "bufferViews");  // before iterators: a new key moves the others
  const auto images = edit.json.find("images");
  if (images == edit.json.end()) return Done{};
  for (Json& image : *images) {
    if (!image.contains("uri") || !(into_binary || is_external(image))) continue;
    const std::string uri = image["uri"].get<std::string>();
    const auto bytes = content_of(uri, character.document.folder);
    if (!bytes) return bytes.error();
    if (bytes->empty()) continue;
    const std::string stated = image.value("mimeType", std::string());
    const std::string mime = stated.empty() ? std::string(image_mime(*bytes)) : stated;
    if (mime.empty())
      return document_error(character, "image '" + uri.substr(0, 80) + "' is not a PNG, JPEG, WebP or KTX2",
                            "convert the image to PNG");
    if (into_binary) {
      image.erase("uri");
      image["bufferView"] = add_view(edit, *bytes);
      image["mimeType"] = mime;
    } else {
      image["uri"] = data_uri(mime, *bytes);
    }
  }
  return Done{};
}

bool has_content(const GltfDocument& document, std::size_t buffer) {
  return buffer < document.buffers.size() && !document.buffers[buffer].empty();
}

/// Buffers from `first` on that are not in the JSON become data URIs.
void embed_buffers(Json& json, const GltfDocument& document, std::size_t first) {
  Json& buffers = json["buffers"];
  for (std::size_t i = first; i < buffers.size(); ++i)
    if (has_content(document, i) && (is_external(buffers[i]) || !buffers[i].contains("uri")))
      buffers[i]["uri"] = data_uri("application/octet-stream", document.buffers[i]);
}

/// Every buffer with content, one behind the other, becomes buffer 0; those without (fallbacks of compressed
/// views) keep their entry.
void merge_buffers(Edit& edit, const GltfDocument& document) {
  Json& views = array_of(edit.json, "bufferViews");
  Json& buffers = edit.json["buffers"];
  Json kept = Json::array({Json::object()});
  std::vector<std::pair<std::size_t, std::size_t>> target;  // buffer, offset
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    if (!has_content(document, i)) {
      target.emplace_back(append(kept, buffers[i]), 0);
      continue;
    }
    target.emplace_back(0, aligned_end(edit.bin));
    edit.bin.insert(edit.bin.end(), document.buffers[i].begin(), document.buffers[i].end());
    if (kept[0].empty()) {
      kept[0] = buffers[i];
      kept[0].erase("uri");
    }
  }
  const auto move_view = [&](Json& view) {
    const auto [buffer, offset] = target.at(view.at("buffer").get<std::size_t>());
    view["buffer"] = buffer;
    if (offset > 0) view["byteOffset"] = view.value("byteOffset", std::size_t{0}) + offset;
  };
  for (Json& view : views) {
    move_view(view);
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
      if (view.contains("extensions") && view["extensions"].contains(name))
        move_view(view["extensions"][name]);
  }
  buffers = std::move(kept);
}

/// Ready to append to the binary chunk.
Status open_for_glb(Edit& edit, const Character& character, bool keep_links) {
  const GltfDocument& document = character.document;
  const Json& buffers = array_of(edit.json, "buffers");
  const bool in_place = document.is_glb && !buffers.empty() && !buffers[0].contains("uri");
  if (!in_place) {
    merge_buffers(edit, document);
  } else {
    if (has_content(document, 0)) edit.bin = document.buffers[0];
    if (!keep_links) embed_buffers(edit.json, document, 1);
  }
  return keep_links && document.is_glb ? Status(Done{}) : embed_images(edit, character, true);
}

/// Ready to append to a buffer of its own.
Status open_for_gltf(Edit& edit, const Character& character, bool keep_links) {
  const Json& buffers = array_of(edit.json, "buffers");
  edit.buffer = buffers.size();
  const bool has_chunk = !buffers.empty() && !buffers[0].contains("uri");
  if (has_chunk || !keep_links) embed_buffers(edit.json, character.document, 0);
  return keep_links ? Status(Done{}) : embed_images(edit, character, false);
}

// ---- the document's nodes
// ------------------------------------------------------------------------------------

/// Leaves the nodes with their transforms, names and extras, and the skins, without their matrices. What held
/// nothing but what is left out says so: a node that holds nothing at all is taken for a mistake.
void keep_skeleton_only(Json& json) {
  for (const char* key : {"meshes", "materials", "textures", "images", "samplers", "animations", "accessors",
                          "bufferViews", "buffers", "extensions", "extensionsUsed", "extensionsRequired"})
    json.erase(key);
  for (Json& node : json["nodes"]) {
    std::string left_out;
    for (const char* key : {"mesh", "skin", "weights", "extensions"})
      if (node.erase(key) > 0 && left_out.empty()) left_out = key;
    const bool is_empty = !node.contains("children") && !node.contains("camera") && !node.contains("extras");
    if (is_empty && !left_out.empty()) node["extras"]["ukemi"]["left_out"] = left_out;
  }
  if (json.contains("skins"))
    for (Json& skin : json["skins"])
      for (const char* key : {"inverseBindMatrices", "extensions"}) skin.erase(key);
}

/// Only nodes without a matrix can be animated.
void matrix_to_trs(Json& node, const LocalTransform& rest) {
  if (!node.contains("matrix")) return;
  node.erase("matrix");
  const Vec3& t = rest.translation;
  const Eigen::Vector4d& r = rest.rotation.coeffs();
  const Vec3& s = rest.scale;
  node["translation"] = {t.x(), t.y(), t.z()};
  node["rotation"] = {r[0], r[1], r[2], r[3]};
  node["scale"] = {s.x(), s.y(), s.z()};
}

/// The scene that viewers show; made from the skeleton's roots where there is none.
Json& default_scene(Json& json, const Skeleton& skeleton) {
  Json& scenes = array_of(json, "scenes");
  if (scenes.empty()) {
    Json roots = Json::array();
    for (const int node : skeleton.order)
      if (skeleton.nodes[node].parent < 0) roots.push_back(node);
    scenes.push_back({{"nodes", std::move(roots)}});
    json["scene"] = 0;
  }
  return scenes.at(json.value("scene", std::size_t{0}));
}

/// Puts the file's units and axes right: glTF is metres, y up.
void add_world_root(Json& json, const Character& character, const Similarity& world_from_file) {
  const Eigen::Vector4d& r = world_from_file.rotation.coeffs();
  const double s = world_from_file.scale;
  if (s == 1.0 && r.head<3>().isZero(1e-12)) return;
  Json& scene = default_scene(json, character.skeleton);
  Json roots = array_of(scene, "nodes");
  const std::size_t world =
      append(json["nodes"], {{"name", character.name.empty() ? "character" : character.name},
                             {"rotation", {r[0], r[1], r[2], r[3]}},
                             {"scale", {s, s, s}},
                             {"children", std::move(roots)}});
  scene["nodes"] = Json::array({world});
}

/// A skinned mesh ignores its node: it goes to one of its own at the scene's root.
void free_skinned_meshes(Json& json, const Skeleton& skeleton) {
  for (int node = 0; node < skeleton.size(); ++node) {
    if (!json["nodes"][node].contains("skin") || !json["nodes"][node].contains("mesh")) continue;
    Json mesh = {{"name", json["nodes"][node].value("name", "") + "_mesh"},
                 {"mesh", json["nodes"][node]["mesh"]},
                 {"skin", json["nodes"][node]["skin"]}};
    json["nodes"][node].erase("mesh");
    json["nodes"][node].erase("skin");
    const std::size_t fresh = append(json["nodes"], std::move(mesh));
    array_of(default_scene(json, skeleton), "nodes").push_back(fresh);
  }
}

// ---- the figure of a skeleton without a mesh
// --------------------------------------------------------------------

Json bounds(const std::vector<Eigen::Vector3f>& points, bool upper) {
  Eigen::Vector3f result = points.front();
  for (const Eigen::Vector3f& p : points)
    result = upper ? result.cwiseMax(p).eval() : result.cwiseMin(p).eval();
  return {result.x(), result.y(), result.z()};
}

/// Accessor of the inverse-bind matrices.
std::size_t add_inverse_binds(Edit& edit, const std::vector<Affine>& inverse_bind) {
  std::vector<float> values;
  for (const Affine& matrix : inverse_bind)
    for (int i = 0; i < 16; ++i) values.push_back(static_cast<float>(matrix.matrix()(i % 4, i / 4)));
  return add_accessor(edit, add_view(edit, values), 0, kFloat, inverse_bind.size(), "MAT4");
}

/// Skins without a mesh: importers take the nodes of a skin, and no others, for the bones of one armature. Of
/// those with the same joints the last one tells importers the bind pose.
void add_bare_skins(Edit& edit, const Character& character, const Humanoid& humanoid) {
  Json skins = Json::array();
  if (character.format != SourceFormat::gltf && character.skins.empty()) {
    skins.push_back({{"joints", character.skeleton.order}});
    skins[0]["inverseBindMatrices"] =
        add_inverse_binds(edit, make_stick_mesh(character, humanoid).inverse_bind);
  }
  const Json all = edit.json.value("skins", Json::array());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto same_joints = [&](const Json& other) { return other["joints"] == all[i]["joints"]; };
    if (std::any_of(all.begin() + static_cast<std::ptrdiff_t>(i) + 1, all.end(), same_joints)) continue;
    skins.push_back(all[i]);
    skins.back()["inverseBindMatrices"] = add_inverse_binds(edit, character.skins.at(i).inverse_bind);
  }
  edit.json.erase("skins");
  if (!skins.empty()) edit.json["skins"] = std::move(skins);
}

/// Accessor of one value per vertex.
template <typename T>
std::size_t add_attribute(Edit& edit, const std::vector<T>& values, int component, const char* type) {
  const std::size_t view = add_view(edit, values);
  edit.json["bufferViews"][view]["target"] = kArrayBuffer;
  return add_accessor(edit, view, 0, component, values.size(), type);
}

Json vertex_attributes(Edit& edit, const StickMesh& figure) {
  std::vector<std::array<std::uint16_t, 4>> joints;
  for (const int node : figure.nodes) joints.push_back({static_cast<std::uint16_t>(node), 0, 0, 0});
  const std::vector<std::array<float, 4>> weights(figure.nodes.size(), {1, 0, 0, 0});
  const std::size_t position = add_attribute(edit, figure.positions, kFloat, "VEC3");
  edit.json["accessors"][position]["min"] = bounds(figure.positions, false);
  edit.json["accessors"][position]["max"] = bounds(figure.positions, true);
  const std::size_t normal = add_attribute(edit, figure.normals, kFloat, "VEC3");
  const std::size_t joint = add_attribute(edit, joints, kUnsignedShort, "VEC4");
  const std::size_t weight = add_attribute(edit, weights, kFloat, "VEC4");
  return {{"POSITION", position}, {"NORMAL", normal}, {"JOINTS_0", joint}, {"WEIGHTS_0", weight}};
}

void add_figure(Edit& edit, const Character& character, const Humanoid& humanoid) {
  const StickMesh figure = make_stick_mesh(character, humanoid);
  if (figure.positions.empty()) return;
  Json joints = Json::array();
  for (int i = 0; i < character.skeleton.size(); ++i) joints.push_back(i);
  const Json attributes = vertex_attributes(edit, figure);
  const std::size_t binds = add_inverse_binds(edit, figure.inverse_bind);
  Json& json = edit.json;
  const std::size_t material = append(
      array_of(json, "materials"),
      {{"name", "figure"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.62, 0.6, 0.56, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}}});
  const std::size_t mesh =
      append(array_of(json, "meshes"),
             {{"name", "figure"},
              {"primitives", Json::array({{{"attributes", attributes}, {"material", material}}})}});
  const std::size_t skin =
      append(array_of(json, "skins"), {{"inverseBindMatrices", binds}, {"joints", joints}});
  const std::size_t node = append(json["nodes"], {{"name", "figure"}, {"mesh", mesh}, {"skin", skin}});
  // A skinned mesh ignores its parents, so it stands beside the skeleton.
  array_of(default_scene(json, character.skeleton), "nodes").push_back(node);
}

// ---- the animation
// -------------------------------------------------------------------------------------------

std::string unique_name(const Json& animations, const std::string& wanted) {
  std::set<std::string> taken;
  for (const Json& animation : animations) taken.insert(animation.value("name", std::string()));
  if (!taken.contains(wanted)) return wanted;
  for (int i = 2;; ++i) {
    const std::string name = wanted + '_' + std::to_string(i);
    if (!taken.contains(name)) return name;
  }
}

std::vector<float> as_floats(const std::vector<double>& values) {
  std::vector<float> result;
  for (const double value : values) result.push_back(static_cast<float>(value));
  return result;
}

/// Key times of all tracks behind each other, equal ones once.
struct TimePool {
  std::vector<float> values;
  std::vector<std::vector<float>> lists;
  std::vector<std::size_t> offsets;   // of each list in values
  std::vector<std::size_t> of_track;  // list of each track
};

TimePool pool_times(const std::vector<Track>& tracks) {
  TimePool pool;
  std::map<std::vector<float>, std::size_t> known;
  for (const Track& track : tracks) {
    std::vector<float> times = as_floats(track.times);
    const auto [entry, fresh] = known.try_emplace(times, pool.lists.size());
    pool.of_track.push_back(entry->second);
    if (!fresh) continue;
    pool.offsets.push_back(pool.values.size());
    pool.values.insert(pool.values.end(), times.begin(), times.end());
    pool.lists.push_back(std::move(times));
  }
  return pool;
}

/// The keys' values of all tracks behind each other.
struct ValuePool {
  Bytes bytes;
  std::vector<std::size_t> offsets;  // of each track

  template <typename T>
  void put(T value) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof(T));
  }
};

/// Vectors as floats; rotations as unit quaternions of floats, or of normalised shorts.
ValuePool pool_values(const ReducedClip& clip) {
  ValuePool pool;
  for (const Track& track : clip.tracks) {
    pool.offsets.push_back(pool.bytes.size());
    if (track.path != TrackPath::rotation) {
      for (const double value : track.values) pool.put(static_cast<float>(value));
      continue;
    }
    for (std::size_t i = 0; i + 4 <= track.values.size(); i += 4) {
      const Eigen::Vector4d q = Eigen::Map<const Eigen::Vector4d>(track.values.data() + i);
      for (const double part : q) {
        if (clip.short_rotations)
          pool.put(static_cast<std::int16_t>(std::lround(std::clamp(part, -1.0, 1.0) * 32767.0)));
        else
          pool.put(static_cast<float>(part / q.norm()));
      }
    }
  }
  return pool;
}

std::vector<std::size_t> add_time_accessors(Edit& edit, const TimePool& pool) {
  std::vector<std::size_t> accessors;
  const std::size_t view = add_view(edit, pool.values);
  for (std::size_t i = 0; i < pool.lists.size(); ++i) {
    const std::vector<float>& times = pool.lists[i];
    accessors.push_back(
        add_accessor(edit, view, pool.offsets[i] * sizeof(float), kFloat, times.size(), "SCALAR"));
    edit.json["accessors"].back()["min"] = Json::array({times.front()});
    edit.json["accessors"].back()["max"] = Json::array({times.back()});
  }
  return accessors;
}

const char* path_name(TrackPath path) {
  switch (path) {
    case TrackPath::translation:
      return "translation";
    case TrackPath::scale:
      return "scale";
    case TrackPath::rotation:
      break;
  }
  return "rotation";
}

void add_animation(Edit& edit, const ReducedClip& clip, const std::string& extras_json) {
  const TimePool pool = pool_times(clip.tracks);
  const std::vector<std::size_t> inputs = add_time_accessors(edit, pool);
  const ValuePool values = pool_values(clip);
  const std::size_t view = add_view(edit, values.bytes);
  Json channels = Json::array();
  Json samplers = Json::array();
  for (std::size_t i = 0; i < clip.tracks.size(); ++i) {
    const Track& track = clip.tracks[i];
    const bool rotation = track.path == TrackPath::rotation;
    const bool is_short = rotation && clip.short_rotations;
    const std::size_t output = add_accessor(edit, view, values.offsets[i], is_short ? kShort : kFloat,
                                            track.times.size(), rotation ? "VEC4" : "VEC3");
    if (is_short) edit.json["accessors"][output]["normalized"] = true;
    const Json sampler = {
        {"input", inputs[pool.of_track[i]]}, {"interpolation", "LINEAR"}, {"output", output}};
    channels.push_back({{"sampler", append(samplers, sampler)},
                        {"target", {{"node", track.node}, {"path", path_name(track.path)}}}});
  }
  Json& animations = array_of(edit.json, "animations");
  Json animation = {{"name", unique_name(animations, clip.name)},
                    {"channels", std::move(channels)},
                    {"samplers", std::move(samplers)}};
  if (!extras_json.empty()) animation["extras"] = Json::parse(extras_json);
  animations.push_back(std::move(animation));
}

// ---- the whole
// -----------------------------------------------------------------------------------------------

Error keys_error(const Character& character, int node) {
  const bool known = node >= 0 && node < character.skeleton.size();
  Error error =
      internal_error("the clip's keys are not finite, not one value per time or not in order of time",
                     "report this as a bug");
  error.file = character.path.string();
  return error_about(known ? character.skeleton.label(node) : "", std::move(error));
}

/// The clip's tracks fit the document and are fit for glTF.
Status check(const Json& json, const Character& character, const ReducedClip& clip) {
  const auto nodes = json.find("nodes");
  if (nodes == json.end() || !nodes->is_array() || nodes->size() != character.skeleton.nodes.size())
    return document_error(character, "the document's nodes are not those of the skeleton",
                          "load the file again");
  if (clip.tracks.empty()) return document_error(character, "the clip is empty", "bake at least one frame");
  for (const Track& track : clip.tracks) {
    const std::vector<float> times = as_floats(track.times);
    const std::size_t width = track.path == TrackPath::rotation ? 4 : 3;
    const bool rising = std::is_sorted(times.begin(), times.end(), std::less_equal<>());
    const bool finite =
        std::all_of(track.values.begin(), track.values.end(), [](double v) { return std::isfinite(v); });
    if (track.node < 0 || track.node >= character.skeleton.size() || times.empty() || !rising || !finite ||
        track.values.size() != times.size() * width)
      return keys_error(character, track.node);
  }
  return Done{};
}

void add_clip(Edit& edit, const Character& character, const Humanoid& humanoid, const ReducedClip& clip,
              const GltfOptions& options) {
  for (const Track& track : clip.tracks)
    matrix_to_trs(edit.json["nodes"][track.node], character.skeleton.nodes[track.node].rest);
  if (character.format != SourceFormat::gltf) {
    add_world_root(edit.json, character, humanoid.world_from_file);
    free_skinned_meshes(edit.json, character.skeleton);
    if (!edit.json.contains("meshes") && !options.clip_only) add_figure(edit, character, humanoid);
  }
  add_animation(edit, clip, options.extras_json);
}

using Open = Status (*)(Edit&, const Character&, bool keep_links);

Result<Edit> edited(const Character& character, const Humanoid& humanoid, const ReducedClip& clip,
                    const GltfOptions& options, Open open) try {
  Edit edit;
  edit.json = Json::parse(character.document.json);
  if (const Status status = check(edit.json, character, clip); !status) return status.error();
  if (options.clip_only) keep_skeleton_only(edit.json);
  const bool keep_links = same_folder(character.document.folder, options.folder);
  if (options.clip_only) {
    Character bare;  // no buffers, no images
    bare.path = character.path;
    bare.document.is_glb = character.document.is_glb;
    if (const Status status = open(edit, bare, true); !status) return status.error();
    add_bare_skins(edit, character, humanoid);
  } else if (const Status status = open(edit, character, keep_links); !status) {
    return status.error();
  }
  add_clip(edit, character, humanoid, clip, options);
  return edit;
} catch (const std::exception& e) {
  return document_error(character, std::string("the glTF document cannot take an animation: ") + e.what(),
                        "check the file with the Khronos glTF validator");
}

}  // namespace

Result<Bytes> write_glb(const Character& character, const Humanoid& humanoid, const ReducedClip& clip,
                        const GltfOptions& options) {
  auto edit = edited(character, humanoid, clip, options, open_for_glb);
  if (!edit) return edit.error();
  Json& buffers = array_of(edit->json, "buffers");
  if (buffers.empty()) buffers.push_back(Json::object());
  buffers[0]["byteLength"] = edit->bin.size();
  const Bytes& further = character.document.extra_chunks;
  return assemble_glb(edit->json.dump(), edit->bin, options.clip_only ? Bytes{} : further);
}

Result<std::string> write_gltf(const Character& character, const Humanoid& humanoid, const ReducedClip& clip,
                               const GltfOptions& options) {
  auto edit = edited(character, humanoid, clip, options, open_for_gltf);
  if (!edit) return edit.error();
  array_of(edit->json, "buffers")
      .push_back(
          {{"byteLength", edit->bin.size()}, {"uri", data_uri("application/octet-stream", edit->bin)}});
  return edit->json.dump(2) + '\n';
}

}  // namespace ukemi
