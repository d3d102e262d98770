#include "export/container.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "base/base64.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/uri.h"

namespace ukemi {
namespace {

void put_u32(std::vector<std::uint8_t>& out, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

constexpr std::size_t padded(std::size_t size) { return (size + 3) / 4 * 4; }

void put_chunk(std::vector<std::uint8_t>& out, std::uint32_t type, std::span<const std::uint8_t> bytes,
               std::uint8_t padding) {
  put_u32(out, padded(bytes.size()));
  put_u32(out, type);
  out.insert(out.end(), bytes.begin(), bytes.end());
  out.resize(padded(out.size()), padding);
}

}  // namespace

Result<std::vector<std::uint8_t>> assemble_glb(std::string json, std::span<const std::uint8_t> bin,
                                               std::span<const std::uint8_t> further) {
  constexpr std::uint32_t kJson = 0x4E4F534A;
  constexpr std::uint32_t kBin = 0x004E4942;
  const std::size_t bin_size = bin.empty() ? 0 : 8 + padded(bin.size());
  const std::size_t size = 12 + 8 + padded(json.size()) + bin_size + further.size();
  if (size > std::numeric_limits<std::uint32_t>::max())
    return input_error({}, "a .glb cannot be larger than 4 GiB", "write a .gltf instead");
  std::vector<std::uint8_t> out{'g', 'l', 'T', 'F', 2, 0, 0, 0};
  out.reserve(size);
  put_u32(out, size);
  put_chunk(out, kJson, {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()}, ' ');
  if (!bin.empty()) put_chunk(out, kBin, bin, 0);
  out.insert(out.end(), further.begin(), further.end());
  return out;
}

std::string data_uri(std::string_view mime, std::span<const std::uint8_t> bytes) {
  return fmt::format("data:{};base64,{}", mime, base64(bytes));
}

std::optional<std::vector<std::uint8_t>> data_of(std::string_view uri) {
  constexpr std::string_view kMark = ";base64,";
  const std::size_t mark = uri.find(kMark);
  if (!uri.starts_with("data:") || mark == std::string_view::npos) return std::nullopt;
  Base64Bytes decoded = base64_decoded(uri.substr(mark + kMark.size()));
  if (!decoded.whole()) return std::nullopt;
  return std::move(decoded.bytes);
}

std::optional<std::filesystem::path> local_file(std::string_view uri, const std::filesystem::path& folder) {
  const std::size_t colon = uri.find(':');
  if (colon != std::string_view::npos && uri.find('/') > colon) return std::nullopt;
  return file_below(folder, percent_decoded(uri));
}

std::string_view image_mime(std::span<const std::uint8_t> bytes) {
  const auto starts = [&](std::size_t at, std::string_view magic) {
    return bytes.size() >= at + magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                      [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
  };
  if (starts(0, "\x89PNG")) return "image/png";
  if (starts(0, "\xff\xd8\xff")) return "image/jpeg";
  if (starts(0, "RIFF") && starts(8, "WEBP")) return "image/webp";
  if (starts(0, "\xabKTX 20")) return "image/ktx2";
  return "";
}

}  // namespace ukemi
