// FBX, DAE and whatever else assimp reads: a child process converts the file to a glTF document, which is
// then read like any other.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/child.h"
#include "base/errors.h"
#include "load/assimp_scene.h"
#include "load/gltf_reader.h"
#include "load/load.h"
#include "load/text.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;
using load::SceneDocument;
using Bytes = std::vector<std::uint8_t>;

constexpr const char* kExportAgain = "export the file again, or export it as .glb";

/// Import that turns exceptions into errors.
Result<SceneDocument> import(std::span<const std::uint8_t> bytes, const std::filesystem::path& path,
                             Diagnostics& diagnostics) {
  try {
    return load::document_from_scene(bytes, path, diagnostics);
  } catch (const load::Refusal& refusal) {
    return input_error(path, refusal.message, refusal.fix);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& exception) {
    return input_error(path, fmt::format("cannot be read: {}", exception.what()), kExportAgain);
  }
}

// The child's message: a line of JSON that states two lengths, then the document's JSON and binary.

Bytes packed(const Result<SceneDocument>& result, const Diagnostics& diagnostics) {
  Json head;
  head["warnings"] = Json::array();
  for (const Warning& warning : diagnostics.warnings())
    head["warnings"].push_back({warning.subject, warning.what});
  Bytes bytes;
  const auto append = [&](const auto& text) { bytes.insert(bytes.end(), text.begin(), text.end()); };
  const auto line = [&] { return head.dump(-1, ' ', true, Json::error_handler_t::replace) + "\n"; };
  if (!result) {
    head["what"] = result.error().what;
    head["fix"] = result.error().fix;
    append(line());
    return bytes;
  }
  const load::GltfContainer& container = result->container;
  head["json_bytes"] = container.document.json.size();
  if (container.has_binary) head["binary_bytes"] = container.binary.size();
  if (result->metres_per_unit) head["metres_per_unit"] = *result->metres_per_unit;
  if (const auto& q = result->yup_from_file) head["yup_from_file"] = {q->x(), q->y(), q->z(), q->w()};
  append(line());
  append(container.document.json);
  append(container.binary);
  return bytes;
}

/// Throws nlohmann's exceptions for messages that no child of this program sends.
Result<SceneDocument> unpacked(const Bytes& bytes, const std::filesystem::path& path,
                               Diagnostics& diagnostics) {
  const auto line_end = std::find(bytes.begin(), bytes.end(), std::uint8_t{'\n'});
  const Json head = Json::parse(bytes.begin(), line_end);
  for (const Json& warning : head.at("warnings"))
    diagnostics.warn(warning.at(0).get<std::string>(), warning.at(1).get<std::string>());
  if (head.contains("what"))
    return input_error(path, head.at("what").get<std::string>(), head.at("fix").get<std::string>());
  SceneDocument scene;
  const std::span body(bytes.data() + (line_end - bytes.begin()) + 1,
                       static_cast<std::size_t>(bytes.end() - line_end) - 1);
  const auto json_bytes = head.at("json_bytes").get<std::size_t>();
  scene.container.has_binary = head.contains("binary_bytes");
  const std::size_t binary_bytes = head.value("binary_bytes", std::size_t{0});
  if (json_bytes > body.size() || binary_bytes != body.size() - json_bytes)
    return input_error(path, "makes its reader send a broken answer", kExportAgain);
  scene.container.document.json.assign(body.begin(), body.begin() + static_cast<std::ptrdiff_t>(json_bytes));
  scene.container.binary.assign(body.begin() + static_cast<std::ptrdiff_t>(json_bytes), body.end());
  if (head.contains("metres_per_unit")) scene.metres_per_unit = head.at("metres_per_unit").get<double>();
  if (head.contains("yup_from_file")) {
    const auto q = head.at("yup_from_file").get<std::array<double, 4>>();
    scene.yup_from_file = Quat(q[3], q[0], q[1], q[2]);
  }
  return scene;
}

Result<SceneDocument> import_in_child(std::span<const std::uint8_t> bytes, const std::filesystem::path& path,
                                      Diagnostics& diagnostics) {
  const auto work = [&] {
    Diagnostics warnings;
    const Result<SceneDocument> result = import(bytes, path, warnings);
    return packed(result, warnings);
  };
  const auto answer = run_in_child(work, ChildLimits{}, path);
  if (!answer) return answer.error();
  try {
    return unpacked(*answer, path, diagnostics);
  } catch (const Json::exception&) {
    return input_error(path, "makes its reader send a broken answer", kExportAgain);
  }
}

}  // namespace

Result<Character> read_with_assimp(std::span<const std::uint8_t> bytes, const std::filesystem::path& path,
                                   Diagnostics& diagnostics) {
  Result<SceneDocument> scene = import_in_child(bytes, path, diagnostics);
  if (!scene) return scene.error();
  Result<Character> character = load::read_container(std::move(scene->container), path, diagnostics);
  if (!character) return character;
  character->format = SourceFormat::assimp;
  character->metres_per_unit = scene->metres_per_unit;
  character->yup_from_file = scene->yup_from_file;
  return character;
}

}  // namespace ukemi
