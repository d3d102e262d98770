#include "load/json_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace ukemi::load {
namespace {

using Json = nlohmann::json;

constexpr int kMaxDepth = 500;
constexpr std::size_t kMostValues = 10'000'000;  // 2 GB of parsed document
constexpr const char* kFix = "correct the file, or export it again";

const Json& json(const void* value) { return *static_cast<const Json*>(value); }

[[noreturn]] void refuse_syntax(std::string_view text, std::size_t offset, const std::string& what) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1;
  const std::size_t line_start = before.rfind('\n') == before.npos ? 0 : before.rfind('\n') + 1;
  throw Refusal("JSON: " + what, kFix, line, static_cast<int>(before.size() - line_start) + 1);
}

/// Refuses nesting so deep that walking the document would exhaust the stack, and more than kMostValues
/// values. They are counted by the bracket, comma or colon before each.
void check_size(std::string_view text) {
  int depth = 0;
  std::size_t values = 1;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxDepth) refuse_syntax(text, i, fmt::format("nested deeper than {}", kMaxDepth));
      ++values;
    } else if (c == '}' || c == ']') {
      --depth;
    } else if (c == ',' || c == ':') {
      ++values;
    }
    if (values > kMostValues) refuse_syntax(text, i, fmt::format("more than {} values", kMostValues));
  }
}

/// The library's message without its own name, number and place.
std::string short_message(const std::string& message) {
  const std::size_t at = message.find("syntax error");
  return at == message.npos ? message.substr(std::min(message.size(), message.find("] ") + 2))
                            : message.substr(at);
}

}  // namespace

JsonDocument::JsonDocument(std::string_view text) {
  check_size(text);
  try {
    auto value = std::make_shared<const Json>(Json::parse(text));
    if (!value->is_object()) refuse_syntax(text, 0, "an object expected");
    value_ = std::move(value);
  } catch (const Json::parse_error& error) {
    refuse_syntax(text, error.byte > 0 ? error.byte - 1 : 0, short_message(error.what()));
  } catch (const Json::out_of_range& error) {
    const std::string message = error.what();
    const std::size_t quote = message.find('\'');
    const std::string token =
        quote == message.npos ? "" : message.substr(quote + 1, message.rfind('\'') - quote - 1);
    refuse_syntax(text, std::min(text.find(token), text.size()),
                  "number out of range: " + token.substr(0, 40));
  }
}

void JsonView::refuse(const std::string& what) const {
  throw Refusal((place_.empty() ? "document" : place_) + " " + what, kFix);
}

bool JsonView::is_object() const { return json(value_).is_object(); }
bool JsonView::is_array() const { return json(value_).is_array(); }

std::optional<JsonView> JsonView::find(const char* key) const {
  if (!is_object()) refuse("is not an object");
  const auto found = json(value_).find(key);
  if (found == json(value_).end()) return std::nullopt;
  return JsonView(&*found, place_.empty() ? key : place_ + "." + key);
}

JsonView JsonView::at(const char* key) const {
  auto member = find(key);
  if (!member) refuse(fmt::format("has no \"{}\"", key));
  return *member;
}

std::vector<JsonView> JsonView::items() const {
  if (!is_array()) refuse("is not an array");
  std::vector<JsonView> views;
  views.reserve(json(value_).size());
  for (const Json& item : json(value_))
    views.emplace_back(&item, fmt::format("{}[{}]", place_, views.size()));
  return views;
}

std::vector<JsonView> JsonView::items(const char* key) const {
  const auto member = find(key);
  return member ? member->items() : std::vector<JsonView>{};
}

std::vector<std::pair<std::string, JsonView>> JsonView::members() const {
  if (!is_object()) refuse("is not an object");
  std::vector<std::pair<std::string, JsonView>> views;
  for (const auto& [key, value] : json(value_).items())
    views.emplace_back(key, JsonView(&value, place_.empty() ? key : place_ + "." + key));
  return views;
}

std::int64_t JsonView::integer(std::int64_t low, std::int64_t high) const {
  const double value = number();
  if (value != std::floor(value)) refuse(fmt::format("is {}, not a whole number", value));
  if (value < static_cast<double>(low) || value > static_cast<double>(high))
    refuse(fmt::format("is {}, outside {} to {}", value, low, high));
  return static_cast<std::int64_t>(value);
}

std::int64_t JsonView::integer(const char* key, std::int64_t low, std::int64_t high,
                               std::int64_t otherwise) const {
  const auto member = find(key);
  return member ? member->integer(low, high) : otherwise;
}

double JsonView::number() const {
  if (!json(value_).is_number()) refuse("is not a number");
  const double value = json(value_).get<double>();
  if (!std::isfinite(value)) refuse("is not finite");
  return value;
}

double JsonView::number(const char* key, double otherwise) const {
  const auto member = find(key);
  return member ? member->number() : otherwise;
}

bool JsonView::boolean(const char* key, bool otherwise) const {
  const auto member = find(key);
  if (!member) return otherwise;
  if (!json(member->value_).is_boolean()) member->refuse("is not true or false");
  return json(member->value_).get<bool>();
}

std::string JsonView::text() const {
  if (!json(value_).is_string()) refuse("is not a string");
  return json(value_).get<std::string>();
}

std::string JsonView::dump() const {
  return json(value_).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string JsonView::text(const char* key, std::string otherwise) const {
  const auto member = find(key);
  return member ? member->text() : otherwise;
}

std::vector<double> JsonView::numbers(const char* key, std::vector<double> otherwise) const {
  const auto member = find(key);
  if (!member) return otherwise;
  const std::vector<JsonView> views = member->items();
  if (views.size() != otherwise.size())
    member->refuse(fmt::format("has {} numbers, not {}", views.size(), otherwise.size()));
  for (std::size_t i = 0; i < views.size(); ++i) otherwise[i] = views[i].number();
  return otherwise;
}

int JsonView::index(std::size_t count, std::string_view items_name) const {
  const std::int64_t value = integer(-(std::int64_t{1} << 53), std::int64_t{1} << 53);
  if (value < 0 || value >= static_cast<std::int64_t>(count))
    refuse(fmt::format("is {}, but there are {} {}", value, count, items_name));
  return static_cast<int>(value);
}

int JsonView::index(const char* key, std::size_t count, std::string_view items_name) const {
  const auto member = find(key);
  return member ? member->index(count, items_name) : -1;
}

}  // namespace ukemi::load
