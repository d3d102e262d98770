#include "load/gltf_container.h"

#include <fmt/format.h>

#include <array>
#include <cstring>

#include "base/base64.h"
#include "base/files.h"
#include "base/uri.h"
#include "load/text.h"

namespace ukemi::load {
namespace {

constexpr const char* kFix = "export the file again, or copy it again if it was cut off";
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

std::uint32_t word_at(std::span<const std::uint8_t> bytes, std::size_t offset) {
  return static_cast<std::uint32_t>(bytes[offset]) | static_cast<std::uint32_t>(bytes[offset + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[offset + 2]) << 16 |
         static_cast<std::uint32_t>(bytes[offset + 3]) << 24;
}

bool has_magic(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

void check_header(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderBytes)
    throw Refusal(fmt::format("GLB header: {} bytes, but 12 are needed", bytes.size()), kFix);
  if (word_at(bytes, 4) != 2)
    throw Refusal(fmt::format("GLB header: version {}, but only 2 is known", word_at(bytes, 4)),
                  "export it as glTF 2.0");
  if (word_at(bytes, 8) < kHeaderBytes || word_at(bytes, 8) > bytes.size())
    throw Refusal(
        fmt::format("GLB header: announces {} bytes, the file has {}", word_at(bytes, 8), bytes.size()),
        kFix);
}

GltfContainer split_glb(std::span<const std::uint8_t> bytes) {
  check_header(bytes);
  GltfContainer container;
  container.bytes_after_end = bytes.size() - word_at(bytes, 8);
  bytes = bytes.first(word_at(bytes, 8));
  container.document.is_glb = true;
  std::size_t offset = kHeaderBytes;
  for (int chunk = 0; offset < bytes.size(); ++chunk) {
    if (bytes.size() - offset < kChunkHeaderBytes)
      throw Refusal(fmt::format("GLB chunk {} at byte {}: header is cut off", chunk, offset), kFix);
    const std::size_t length = word_at(bytes, offset);
    const std::uint32_t type = word_at(bytes, offset + 4);
    if (length > bytes.size() - offset - kChunkHeaderBytes)
      throw Refusal(fmt::format("GLB chunk {} at byte {}: announces {} bytes, {} are left", chunk, offset,
                                length, bytes.size() - offset - kChunkHeaderBytes),
                    kFix);
    const auto content = bytes.subspan(offset + kChunkHeaderBytes, length);
    if (chunk == 0 && type != kJsonChunk) throw Refusal("GLB: the first chunk is not JSON", kFix);
    if (chunk == 0) {
      container.document.json.assign(content.begin(), content.end());
    } else if (chunk == 1 && type == kBinaryChunk) {
      container.has_binary = true;
      container.binary.assign(content.begin(), content.end());
    } else {
      const auto whole = bytes.subspan(offset, kChunkHeaderBytes + length);
      auto& extra = container.document.extra_chunks;
      extra.insert(extra.end(), whole.begin(), whole.end());
    }
    offset += kChunkHeaderBytes + length;
  }
  if (offset == kHeaderBytes) throw Refusal("GLB: has no chunks", kFix);
  return container;
}

std::vector<std::uint8_t> bytes_of_base64(const JsonView& place, std::string_view text) {
  Base64Bytes decoded = base64_decoded(text);
  if (decoded.cut_off) place.refuse("has base64 that is cut off");
  if (!decoded.whole()) place.refuse(fmt::format("has malformed base64 at character {}", decoded.bad_at));
  return std::move(decoded.bytes);
}

std::vector<std::uint8_t> decode_data_uri(const JsonView& place, std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == uri.npos) place.refuse("is a data: URI without a comma");
  const std::string_view head = uri.substr(0, comma);
  const std::string_view body = uri.substr(comma + 1);
  if (head.ends_with(";base64"))
    return body.find('%') == body.npos ? bytes_of_base64(place, body)
                                       : bytes_of_base64(place, percent_decoded(body));
  const std::string plain = percent_decoded(body);
  return {plain.begin(), plain.end()};
}

bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != uri.npos && uri.substr(0, colon).find_first_of("/?#") == uri.npos;
}

/// Refuses everything but a relative path that stays below the document's folder.
std::filesystem::path safe_path(const JsonView& place, const std::string& uri,
                                const std::filesystem::path& folder) {
  const std::string decoded = percent_decoded(uri);
  const bool plain = decoded.find('\\') == decoded.npos && !has_scheme(decoded);
  const auto path = plain ? file_below(folder, decoded) : std::nullopt;
  if (!path)
    throw Refusal(
        fmt::format("{} is {}, which is not a file beside the document", place.place(), load::quoted(uri)),
        "put the file into the document's folder and name it by a relative path");
  return *path;
}

}  // namespace

GltfContainer split_container(std::span<const std::uint8_t> bytes) {
  if (has_magic(bytes)) return split_glb(bytes);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t start = text.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  if (start == text.npos || text[start] != '{')
    throw Refusal("is no glTF: it starts neither with \"glTF\" (GLB) nor with \"{\" (JSON)",
                  "name a .glb, .gltf or .vrm file that a glTF program can open");
  GltfContainer container;
  container.document.json.assign(bytes.begin(), bytes.end());
  return container;
}

Result<std::vector<std::uint8_t>> resolve_uri(const JsonView& uri, const std::filesystem::path& folder) {
  const std::string text = uri.text();
  if (text.starts_with("data:")) return decode_data_uri(uri, text);
  return read_file(safe_path(uri, text, folder), static_cast<std::size_t>(kMaxBufferBytes));
}

void resolve_buffers(const JsonView& root, GltfContainer& container, MemoryBudget& budget) {
  GltfDocument& document = container.document;
  for (const JsonView& buffer : root.items("buffers")) {
    const auto announced = static_cast<std::size_t>(buffer.at("byteLength").integer(1, kMaxBufferBytes));
    std::vector<std::uint8_t> bytes;
    budget.spend(announced, buffer.place());
    if (const auto uri = buffer.find("uri")) {
      auto resolved = resolve_uri(*uri, document.folder);
      if (!resolved)
        throw Refusal(fmt::format("{}: {}", uri->place(), resolved.error().message()),
                      "put the file beside the document, or use a .glb");
      bytes = std::move(*resolved);
    } else if (document.buffers.empty() && container.has_binary) {
      bytes = std::move(container.binary);
    } else {
      const auto extensions = buffer.find("extensions");
      const auto meshopt = extensions ? extensions->find("EXT_meshopt_compression") : std::nullopt;
      if (document.is_glb && document.buffers.empty() && !meshopt)
        buffer.refuse("has no uri, and the GLB has no BIN chunk");
      document.buffers.emplace_back();
      continue;
    }
    if (bytes.size() < announced)
      buffer.refuse(fmt::format("announces {} bytes and has {}", announced, bytes.size()));
    bytes.resize(announced);
    document.buffers.push_back(std::move(bytes));
  }
}

}  // namespace ukemi::load
