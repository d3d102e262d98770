// Bytes around a glTF document: GLB chunks, data URIs, relative URIs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace ukemi {

/// Chunks JSON (padded with spaces), BIN (padded with zeros; left out when empty) and `further`, which holds
/// whole chunks. Errors: input, when the file would pass 4 GiB.
Result<std::vector<std::uint8_t>> assemble_glb(std::string json, std::span<const std::uint8_t> bin,
                                               std::span<const std::uint8_t> further);

/// "data:MIME;base64,..."
std::string data_uri(std::string_view mime, std::span<const std::uint8_t> bytes);

/// Content of a base64 data URI; nothing when it is malformed or none.
std::optional<std::vector<std::uint8_t>> data_of(std::string_view uri);

/// The file below the folder that a relative URI names; nothing for data URIs, other schemes and what leads
/// out.
std::optional<std::filesystem::path> local_file(std::string_view uri, const std::filesystem::path& folder);

/// MIME type of an encoded image by its first bytes; "" when it is none that glTF takes.
std::string_view image_mime(std::span<const std::uint8_t> bytes);

}  // namespace ukemi
