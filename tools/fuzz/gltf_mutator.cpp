// Mutates glTF so that the change gets past the container: chunk lengths stay valid, and the JSON is changed
// as a tree as often as byte by byte. Linked into every fuzzer; input that is no glTF is mutated as bytes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/random.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using Json = nlohmann::ordered_json;
using ukemi::Random;

constexpr std::size_t kHeaders = 12 + 8 + 8 + 6;  // and paddings

struct Parts {
  bool glb = false;
  std::string json;
  std::string binary;
};

std::uint32_t word_at(const std::uint8_t* data) {
  std::uint32_t word = 0;
  std::memcpy(&word, data, sizeof word);
  return word;
}

void put_word(std::string& out, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  out.append(reinterpret_cast<const char*>(&word), sizeof word);
}

/// False where the bytes are no glTF.
bool split(const std::uint8_t* data, std::size_t size, Parts& parts) {
  if (size > 0 && data[0] == '{') {
    parts.json.assign(data, data + size);
    return true;
  }
  if (size < 20 || std::memcmp(data, "glTF", 4) != 0) return false;
  parts.glb = true;
  const std::size_t length = std::min<std::size_t>(word_at(data + 12), size - 20);
  parts.json.assign(data + 20, data + 20 + length);
  const std::size_t binary = 20 + length + 8;
  if (binary < size) parts.binary.assign(data + binary, data + size);
  return true;
}

std::string joined(Parts parts) {
  if (!parts.glb) return std::move(parts.json);
  parts.json.resize((parts.json.size() + 3) / 4 * 4, ' ');
  parts.binary.resize((parts.binary.size() + 3) / 4 * 4);
  std::string out = "glTF";
  put_word(out, 2);
  put_word(out, 12 + 8 + parts.json.size() + (parts.binary.empty() ? 0 : 8 + parts.binary.size()));
  put_word(out, parts.json.size());
  put_word(out, 0x4E4F534A);
  out += parts.json;
  if (parts.binary.empty()) return out;
  put_word(out, parts.binary.size());
  put_word(out, 0x004E4942);
  return out + parts.binary;
}

void mutate_bytes(std::string& bytes, std::size_t most) {
  const std::size_t size = bytes.size();
  bytes.resize(std::max(most, size));
  bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, bytes.size()));
}

void collect(Json& value, std::vector<Json*>& out) {
  out.push_back(&value);
  for (Json& item : value)
    if (value.is_structured()) collect(item, out);
}

std::size_t below(Random& random, std::size_t count) { return count == 0 ? 0 : random.next() % count; }

Json odd_number(Random& random) {
  static const std::array<double, 14> kOdd{0,     1,     2,          3,     -1,  1e30, 1e-30,
                                           65535, 65536, 2147483648, 1e308, 0.5, 255,  4294967295.0};
  const double number = kOdd[below(random, kOdd.size())];
  const bool whole = number == std::floor(number) && std::abs(number) < 1e15;
  return whole ? Json(static_cast<std::int64_t>(number)) : Json(number);
}

Json odd_text(Random& random) {
  static const std::array<const char*, 18> kOdd{"",         "SCALAR", "VEC2",    "VEC3",        "VEC4",
                                                "MAT4",     "STEP",   "LINEAR",  "CUBICSPLINE", "translation",
                                                "rotation", "scale",  "weights", "../x",        "file:x",
                                                "data:,",   "2.0",    "hips"};
  return kOdd[below(random, kOdd.size())];
}

/// A change of one value of the tree.
void change(Json& value, const Json& other, Random& random) {
  switch (below(random, 7)) {
    case 0:
      value = other;
      return;
    case 1:
      if (value.is_array() && !value.empty()) value.push_back(value[below(random, value.size())]);
      return;
    case 2:
      if (value.is_array() && !value.empty())
        value.erase(value.begin() + static_cast<std::ptrdiff_t>(below(random, value.size())));
      else if (value.is_object() && !value.empty())
        value.erase(std::next(value.begin(), static_cast<std::ptrdiff_t>(below(random, value.size()))).key());
      return;
    case 3:
      if (value.is_number_integer()) value = value.get<std::int64_t>() + (random.next() % 2 == 0 ? 1 : -1);
      return;
    case 4:
      value = odd_text(random);
      return;
    case 5:
      if (value.is_object()) value["extensions"]["KHR_draco_mesh_compression"] = other;
      return;
    default:
      value = odd_number(random);
  }
}

void mutate_tree(Parts& parts, Random& random) {
  Json json = Json::parse(parts.json, nullptr, false);
  if (json.is_discarded()) return mutate_bytes(parts.json, parts.json.size() + 64);
  for (std::size_t count = 1 + below(random, 3); count > 0; --count) {
    std::vector<Json*> values;
    collect(json, values);
    const Json other = *values[below(random, values.size())];
    Json& value = *values[below(random, values.size())];
    if (&value == &json) continue;
    change(value, other, random);
  }
  if (random.next() % 2 == 0 && json.is_object() && json.contains("buffers") && json["buffers"].is_array() &&
      !json["buffers"].empty() && json["buffers"][0].is_object() && !parts.binary.empty())
    json["buffers"][0]["byteLength"] = parts.binary.size();
  parts.json = json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void mutate_floats(std::string& binary, Random& random) {
  static const std::array<float, 8> kOdd{0.0f,  1.0f,   -1.0f, std::numeric_limits<float>::quiet_NaN(),
                                         1e30f, 1e-30f, 0.5f,  std::numeric_limits<float>::infinity()};
  if (binary.size() < 4) return;
  const std::size_t at = below(random, binary.size() / 4) * 4;
  std::memcpy(binary.data() + at, &kOdd[below(random, kOdd.size())], 4);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  Random random(seed + 1);
  Parts parts;
  if (random.next() % 16 == 0 || !split(data, size, parts)) return LLVMFuzzerMutate(data, size, max_size);
  const std::size_t most =
      max_size > kHeaders + parts.binary.size() ? max_size - kHeaders - parts.binary.size() : 0;
  switch (below(random, 4)) {
    case 0:
      mutate_bytes(parts.json, most);
      break;
    case 1:
      if (random.next() % 2 == 0)
        mutate_bytes(parts.binary, parts.binary.size() + 16);
      else
        mutate_floats(parts.binary, random);
      break;
    default:
      mutate_tree(parts, random);
  }
  const std::string bytes = joined(std::move(parts));
  if (bytes.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, bytes.data(), bytes.size());
  return bytes.size();
}
