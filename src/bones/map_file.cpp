#include "bones/map_file.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/errors.h"
#include "base/files.h"
#include "base/parse_segment.h"
#include "base/segments.h"

namespace ukemi {
namespace {

using Map = std::map<std::string, std::string>;

constexpr std::size_t kMostBytes = 1 << 20;

Error map_error(const std::string& file, std::string what, std::string fix,
                const toml::source_region& where = {}) {
  return error_at(where.begin, input_error(file, std::move(what), std::move(fix)));
}

Error no_text(const std::string& file, std::string_view segment, const toml::source_region& where = {}) {
  return map_error(file, fmt::format("the node of '{}' is not a text", segment),
                   "write its name or \"#INDEX\" in quotes", where);
}

Result<Map> map_of_toml(std::string_view text, const std::string& file) {
  try {
    const toml::table document = toml::parse(text, file);
    const toml::table* table = document.get_as<toml::table>("map");
    Map map;
    for (const auto& [key, node] : table ? *table : document) {
      const std::string segment(key.str());
      if (const auto known = parse_segment(segment); !known)
        return map_error(file, known.error().what, known.error().fix, key.source());
      const auto value = node.value_exact<std::string>();
      if (!value || value->empty()) return no_text(file, segment, node.source());
      map.emplace(segment, *value);
    }
    return map;
  } catch (const toml::parse_error& error) {
    return map_error(file, std::string(error.description()), "correct the TOML syntax", error.source());
  }
}

Result<Map> map_of_json(std::string_view text, const std::string& file) {
  using Json = nlohmann::ordered_json;
  try {
    const Json document = Json::parse(text);
    const auto found = document.find("map");
    Map map;
    for (const auto& [segment, node] : (found != document.end() ? *found : document).items()) {
      if (const auto known = parse_segment(segment); !known)
        return map_error(file, known.error().what, known.error().fix);
      if (node.is_null()) continue;
      if (!node.is_string() || node.get_ref<const std::string&>().empty()) return no_text(file, segment);
      map.emplace(segment, node.get<std::string>());
    }
    return map;
  } catch (const Json::exception& error) {
    return map_error(file, error.what(), "correct the JSON syntax");
  }
}

}  // namespace

Result<Map> parse_map(std::string_view text, const std::string& file) {
  const std::size_t start = text.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  auto map = start != text.npos && text[start] == '{' ? map_of_json(text, file) : map_of_toml(text, file);
  if (map && map->empty())
    return map_error(file, "names no segment", "write pelvis = \"Hips\" and so on, or save inspect --json");
  return map;
}

Result<Map> read_map(const std::string& file) {
  const auto bytes = read_file(file, kMostBytes);
  if (!bytes) return bytes.error();
  return parse_map({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, file);
}

}  // namespace ukemi
