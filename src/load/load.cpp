#include "load/load.h"

#include "base/errors.h"
#include "base/files.h"
#include "load/text.h"

namespace ukemi {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

}  // namespace

Result<Character> load_character(const std::filesystem::path& path, const LoadOptions& options,
                                 Diagnostics& diagnostics) {
  const auto bytes = read_file(path, options.max_file_bytes);
  if (!bytes) return bytes.error();
  if (bytes->empty()) return input_error(path, "is empty", "use a file with content");
  const std::string extension = lower_extension(path);
  if (extension == ".bvh")
    return read_bvh({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, path, diagnostics);
  if (extension == ".glb" || extension == ".gltf" || extension == ".vrm" || extension == ".vrma")
    return read_gltf(*bytes, path, diagnostics);
  return read_with_assimp(*bytes, path, diagnostics);
}

}  // namespace ukemi
