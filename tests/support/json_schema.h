// Checks JSON against the part of JSON Schema (draft 2020-12) that assets/schemas uses.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace ukemi::test {

/// A schema with a keyword that the check does not know is refused: no condition goes unchecked.
class JsonSchema {
 public:
  using Json = nlohmann::json;

  explicit JsonSchema(Json schema) : schema_(std::move(schema)) {}

  /// "/place: what is wrong", one for each fault; empty where the value is as described.
  std::vector<std::string> faults(const Json& value) const {
    std::vector<std::string> found;
    check(schema_, value, "", found);
    return found;
  }

 private:
  using Faults = std::vector<std::string>;

  static bool has_type(const Json& value, const std::string& type) {
    if (type == "integer")
      return value.is_number_integer() ||
             (value.is_number_float() && std::floor(value.get<double>()) == value.get<double>());
    if (type == "number") return value.is_number();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "array") return value.is_array();
    if (type == "object") return value.is_object();
    return type == "null" && value.is_null();
  }
  static bool has_any_type(const Json& value, const Json& types) {
    if (types.is_string()) return has_type(value, types.get<std::string>());
    return std::any_of(types.begin(), types.end(),
                       [&](const Json& type) { return has_type(value, type.get<std::string>()); });
  }

  void check(const Json& schema, const Json& value, const std::string& at, Faults& faults) const {
    constexpr std::array<std::string_view, 16> kKnown = {"$schema",
                                                         "$defs",
                                                         "title",
                                                         "description",
                                                         "$ref",
                                                         "type",
                                                         "const",
                                                         "enum",
                                                         "properties",
                                                         "required",
                                                         "additionalProperties",
                                                         "propertyNames",
                                                         "minProperties",
                                                         "items",
                                                         "minItems",
                                                         "maxItems"};
    if (schema.is_boolean()) {
      if (!schema.get<bool>()) faults.push_back(at + ": is not described");
      return;
    }
    for (const auto& [keyword, rule] : schema.items())
      if (std::find(kKnown.begin(), kKnown.end(), keyword) == kKnown.end())
        faults.push_back(at + ": the schema has the unknown keyword " + keyword);
    if (schema.contains("$ref"))
      check(schema_.at(Json::json_pointer(schema["$ref"].get<std::string>().substr(1))), value, at, faults);
    check_value(schema, value, at, faults);
    if (value.is_object()) check_object(schema, value, at, faults);
    if (value.is_array()) check_array(schema, value, at, faults);
  }

  static void check_value(const Json& schema, const Json& value, const std::string& at, Faults& faults) {
    if (schema.contains("type") && !has_any_type(value, schema["type"]))
      faults.push_back(at + ": is of the wrong type: " + value.dump());
    if (schema.contains("const") && value != schema["const"])
      faults.push_back(at + ": is not " + schema["const"].dump());
    if (!schema.contains("enum")) return;
    const Json& words = schema["enum"];
    if (std::find(words.begin(), words.end(), value) == words.end())
      faults.push_back(at + ": is none of the words: " + value.dump());
  }

  void check_object(const Json& schema, const Json& object, const std::string& at, Faults& faults) const {
    for (const Json& key : schema.value("required", Json::array()))
      if (!object.contains(key.get<std::string>()))
        faults.push_back(at + "/" + key.get<std::string>() + ": is missing");
    if (object.size() < schema.value("minProperties", std::size_t{0}))
      faults.push_back(at + ": has too few keys");
    const Json properties = schema.value("properties", Json::object());
    for (const auto& [key, value] : object.items()) {
      const std::string below = at + "/" + key;
      if (schema.contains("propertyNames")) check(schema["propertyNames"], key, below, faults);
      if (properties.contains(key))
        check(properties[key], value, below, faults);
      else if (schema.contains("additionalProperties"))
        check(schema["additionalProperties"], value, below, faults);
    }
  }

  void check_array(const Json& schema, const Json& array, const std::string& at, Faults& faults) const {
    if (array.size() < schema.value("minItems", std::size_t{0})) faults.push_back(at + ": has too few items");
    if (array.size() > schema.value("maxItems", array.size())) faults.push_back(at + ": has too many items");
    if (!schema.contains("items")) return;
    for (std::size_t i = 0; i < array.size(); ++i)
      check(schema["items"], array[i], at + "/" + std::to_string(i), faults);
  }

  Json schema_;
};

}  // namespace ukemi::test
