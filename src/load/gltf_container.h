// The outside of a glTF file: GLB chunks, URIs and buffers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "base/character.h"
#include "base/result.h"
#include "load/json_view.h"
#include "load/memory_budget.h"

namespace ukemi::load {

/// Largest size of one buffer, image or decompressed view.
inline constexpr std::int64_t kMaxBufferBytes = std::int64_t{1} << 30;

/// A document split from its file; buffers are not resolved yet.
struct GltfContainer {
  GltfDocument document;
  bool has_binary = false;
  std::vector<std::uint8_t> binary;  // the BIN chunk
  std::size_t bytes_after_end = 0;   // of a GLB that is longer than it says
};
/// Splits a .glb into its chunks (checked lengths) or takes the bytes as JSON. Throws Refusal.
GltfContainer split_container(std::span<const std::uint8_t> bytes);

/// What a data: URI holds, or the file beside the document. Throws Refusal for a URI that is malformed, has
/// another scheme, or leaves the folder. A file that cannot be read is an Error.
Result<std::vector<std::uint8_t>> resolve_uri(const JsonView& uri, const std::filesystem::path& folder);

/// Fills document.buffers: buffer i has the bytes it announces, or none for a buffer without data (the
/// fallback of a compressed one). Throws Refusal.
void resolve_buffers(const JsonView& root, GltfContainer& container, MemoryBudget& budget);

}  // namespace ukemi::load
