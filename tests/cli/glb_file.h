// A .glb taken apart, changed and put together again.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ukemi::test {

struct GlbFile {
  nlohmann::ordered_json json;
  std::string binary;

  explicit GlbFile(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    json = nlohmann::ordered_json::parse(bytes.substr(20, length));
    binary = bytes.substr(20 + length + 8);
  }

  /// A further accessor of floats.
  int add(const std::vector<float>& numbers, const char* type, std::size_t width) {
    binary.resize((binary.size() + 3) / 4 * 4);
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", numbers.size() * 4}});
    binary.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * 4);
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", 5126},
                                 {"type", type},
                                 {"count", numbers.size() / width}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  void write(const std::filesystem::path& path) {
    binary.resize((binary.size() + 3) / 4 * 4);
    json["buffers"][0]["byteLength"] = binary.size();
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::ofstream file(path, std::ios::binary);
    const auto put = [&](std::size_t number) {
      const auto word = static_cast<std::uint32_t>(number);
      file.write(reinterpret_cast<const char*>(&word), 4);
    };
    file << "glTF";
    put(2);
    put(28 + text.size() + binary.size());
    put(text.size());
    file << "JSON" << text;
    put(binary.size());
    file.write("BIN\0", 4) << binary;
  }
};

}  // namespace ukemi::test
