#include "bake/outputs.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "base/errors.h"
#include "base/file_names.h"
#include "prepare/impact.h"
#include "prepare/settings.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

Error cannot_write(const fs::path& path, const std::string& why, std::string fix) {
  return output_error(path, "cannot write: " + why, std::move(fix));
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::weakly_canonical(fs::absolute(a, error), error) ==
         fs::weakly_canonical(fs::absolute(b, error), error);
}

bool names_folder(const fs::path& path) {
  std::error_code error;
  return !path.empty() && (!path.has_filename() || (!path.has_extension() && fs::is_directory(path, error)));
}

/// "hero_head_left_punch", "hero_pelvis_back_slope", "hero_head_left_punch_seed3"
std::string stem_of(const std::string& character, const BakeSettings& settings) {
  const std::string what = settings.scene ? std::string(name(*settings.scene)) : settings.preset;
  std::string stem =
      fmt::format("{}_{}_{}", fs::path(character).stem().string(), reaction_name(settings), what);
  if (settings.seed > 0.0) stem += fmt::format("_seed{}", settings.seed);
  return file_name_from(stem);
}

}  // namespace

void name_outputs(const std::string& character, BakeSettings& settings) {
  const std::string stem = stem_of(character, settings);
  const auto complete = [&stem](fs::path& path, const char* extension) {
    if (names_folder(path)) path /= stem + extension;
  };
  const auto format = output_format(character);
  const char* own = format == OutputFormat::bvh ? ".bvh" : format == OutputFormat::fbx ? ".fbx" : ".glb";
  for (fs::path& output : settings.outputs) complete(output, own);
  complete(settings.sheet, ".png");
  complete(settings.preview, ".webp");
  complete(settings.report, ".json");
}

std::optional<OutputFormat> output_format(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".glb") return OutputFormat::glb;
  if (extension == ".gltf") return OutputFormat::gltf;
  if (extension == ".bvh") return OutputFormat::bvh;
  if (extension == ".fbx") return OutputFormat::fbx;
  if (extension == ".vrm") return OutputFormat::vrm;
  if (extension == ".vrma") return OutputFormat::vrma;
  return std::nullopt;
}

Status check_writable(const fs::path& path) {
  std::error_code error;
  const fs::file_status target = fs::status(path, error);
  if (fs::is_directory(target)) return cannot_write(path, "is a directory", "name a file");
  if (fs::exists(target) && !fs::is_regular_file(target))
    return cannot_write(path, "is not a regular file", "name a file");
  if (target.type() == fs::file_type::none && error != std::errc::permission_denied)
    return cannot_write(path, error.message(), "choose another name for the output");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    return cannot_write(path, fmt::format("there is no folder '{}'", folder.string()),
                        "make the folder first");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    return cannot_write(path, fmt::format("the folder '{}' may not be written to", folder.string()),
                        "choose another folder, or change its permissions");
  return Done{};
}

Status check_picture_name(const fs::path& path) {
  if (lower_extension(path) == ".png") return Done{};
  return usage_error(path, "unknown picture format", "let the name end in .png");
}

Status check_outputs(const std::string& character, const BakeSettings& settings) {
  std::vector<fs::path> paths = settings.outputs;
  for (const fs::path& path : settings.outputs)
    if (!output_format(path))
      return usage_error(path, "unknown output format",
                         "let the name end in .glb, .gltf, .vrm, .vrma, .fbx or .bvh");
  if (!settings.sheet.empty()) {
    if (const Status status = check_picture_name(settings.sheet); !status) return status.error();
    paths.push_back(settings.sheet);
  }
  if (!settings.preview.empty()) {
    if (lower_extension(settings.preview) != ".webp")
      return usage_error(settings.preview, "unknown format of a moving picture", "let the name end in .webp");
    paths.push_back(settings.preview);
  }
  for (const fs::path& file : {settings.report, settings.events})
    if (!file.empty()) paths.push_back(file);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (same_file(paths[i], character))
      return usage_error(paths[i], "would overwrite the character", "choose another name for the output");
    for (std::size_t k = 0; k < i; ++k)
      if (same_file(paths[i], paths[k]))
        return usage_error(paths[i], "is named twice as an output", "name each output once");
    if (const Status status = check_writable(paths[i]); !status) return status.error();
  }
  return Done{};
}

}  // namespace ukemi
