// What may be missing, as JSON. A template on the JSON type, so that `base` needs no JSON library.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace ukemi {

template <typename Json, typename T>
Json or_null(const T& value) {
  return value;
}
template <typename Json, typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}
/// Null for text without a character.
template <typename Json>
Json text_or_null(std::string_view text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

}  // namespace ukemi
