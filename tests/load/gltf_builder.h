// Builds small glTF documents for tests.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/base64.h"
#include "load/load.h"

namespace ukemi::test {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<std::uint8_t>;

inline void append_word(Bytes& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
}

/// A document with one buffer.
struct Document {
  Json json{{"asset", {{"version", "2.0"}}}};
  Bytes binary;

  int view(const void* data, std::size_t size, int stride = 0) {
    binary.resize((binary.size() + 3) / 4 * 4);
    Json view{{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", size}};
    if (stride > 0) view["byteStride"] = stride;
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    binary.insert(binary.end(), bytes, bytes + size);
    json["bufferViews"].push_back(view);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }
  int accessor(const Json& fields) {
    json["accessors"].push_back(fields);
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  /// Tightly packed accessor over `numbers`.
  template <typename Number>
  int add(const std::vector<Number>& numbers, int component_type, const char* type, std::size_t width,
          bool normalized = false) {
    const int v = view(numbers.data(), numbers.size() * sizeof(Number));
    Json fields{{"bufferView", v},
                {"componentType", component_type},
                {"count", numbers.size() / width},
                {"type", type}};
    if (normalized) fields["normalized"] = true;
    return accessor(fields);
  }
  int floats(const std::vector<float>& numbers, const char* type, std::size_t width) {
    return add(numbers, 5126, type, width);
  }

  Bytes glb() const {
    Json whole = json;
    if (!binary.empty() && !whole.contains("buffers")) whole["buffers"] = {{{"byteLength", binary.size()}}};
    return glb_of(whole.dump(), binary);
  }
  static Bytes glb_of(std::string text, Bytes content) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    content.resize((content.size() + 3) / 4 * 4);
    Bytes bytes{'g', 'l', 'T', 'F'};
    append_word(bytes, 2);
    append_word(
        bytes, static_cast<std::uint32_t>(12 + 8 + text.size() + (content.empty() ? 0 : 8 + content.size())));
    append_word(bytes, static_cast<std::uint32_t>(text.size()));
    append_word(bytes, 0x4E4F534A);
    bytes.insert(bytes.end(), text.begin(), text.end());
    if (content.empty()) return bytes;
    append_word(bytes, static_cast<std::uint32_t>(content.size()));
    append_word(bytes, 0x004E4942);
    bytes.insert(bytes.end(), content.begin(), content.end());
    return bytes;
  }
  std::string gltf() const {
    Json whole = json;
    if (!binary.empty() && !whole.contains("buffers"))
      whole["buffers"] = {
          {{"byteLength", binary.size()}, {"uri", "data:application/octet-stream;base64," + base64(binary)}}};
    return whole.dump(1);
  }
};

inline Result<Character> read(const Bytes& bytes) {
  Diagnostics diagnostics;
  return read_gltf(bytes, "folder/model.glb", diagnostics);
}
inline Result<Character> read(const std::string& text) { return read(Bytes(text.begin(), text.end())); }

/// Hips with a child, a skinned square of two triangles, and an animation of the child.
inline Document skinned_square() {
  Document d;
  d.json["scene"] = 0;
  d.json["scenes"] = {{{"nodes", {0, 2}}}};
  d.json["nodes"] = {{{"name", "hips"}, {"children", {1}}, {"translation", {0, 1, 0}}},
                     {{"name", "spine"}, {"rotation", {0, 0, 0, 1}}, {"translation", {0, 0.5, 0}}},
                     {{"name", "body"}, {"mesh", 0}, {"skin", 0}}};
  const int positions = d.floats({0, 0, 0, 1, 0, 0, 1, 2, 0, 0, 2, 0}, "VEC3", 3);
  const int joints = d.add<std::uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 5121, "VEC4", 4);
  const int weights = d.floats({0.75f, 0.25f, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4);
  const int indices = d.add<std::uint16_t>({0, 1, 2, 0, 2, 3}, 5123, "SCALAR", 1);
  std::vector<float> inverse_bind(32, 0.0f);
  for (std::size_t m = 0; m < 2; ++m)
    for (std::size_t k = 0; k < 4; ++k) inverse_bind[16 * m + 5 * k] = 1.0f;
  inverse_bind[13] = -1.0f;
  inverse_bind[29] = -1.5f;
  const int matrices = d.floats(inverse_bind, "MAT4", 16);
  const int times = d.floats({0.5f, 1.0f, 2.0f}, "SCALAR", 1);
  const int rotations = d.floats({0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1}, "VEC4", 4);
  d.json["meshes"] = {
      {{"primitives",
        {{{"attributes", {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
          {"indices", indices}}}}}};
  d.json["skins"] = {{{"joints", {0, 1}}, {"inverseBindMatrices", matrices}}};
  d.json["animations"] = {
      {{"name", "turn"},
       {"samplers", {{{"input", times}, {"output", rotations}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}}};
  return d;
}

}  // namespace ukemi::test
