// Reading JSON that may be malformed: every access is checked and a refusal names the place
// ("accessors[3].count").
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ukemi::load {

/// Malformed input. Thrown inside the glTF reader only and turned into an Error at read_gltf's edge.
struct Refusal : std::exception {
  Refusal(std::string what_text, std::string fix_text, int line_number = 0, int column_number = 0)
      : message(std::move(what_text)), fix(std::move(fix_text)), line(line_number), column(column_number) {}
  const char* what() const noexcept override { return message.c_str(); }

  std::string message;
  std::string fix;
  int line = 0;
  int column = 0;
};

/// A value of a JSON document and its place in it. The document must outlive its views.
class JsonView {
 public:
  JsonView(const void* value, std::string place) : value_(value), place_(std::move(place)) {}

  const std::string& place() const { return place_; }
  [[noreturn]] void refuse(const std::string& what) const;

  bool is_object() const;
  bool is_array() const;
  /// Member of an object; refuses what is no object.
  std::optional<JsonView> find(const char* key) const;
  JsonView at(const char* key) const;  // refuses when missing
  /// Items of the array `key`, or none when there is no such member.
  std::vector<JsonView> items(const char* key) const;
  std::vector<JsonView> items() const;
  /// Members of an object, sorted by name.
  std::vector<std::pair<std::string, JsonView>> members() const;

  /// A whole number in [low, high]; 3.0 counts as 3.
  std::int64_t integer(std::int64_t low, std::int64_t high) const;
  std::int64_t integer(const char* key, std::int64_t low, std::int64_t high, std::int64_t otherwise) const;
  double number() const;  // finite
  double number(const char* key, double otherwise) const;
  bool boolean(const char* key, bool otherwise) const;
  std::string text() const;
  std::string dump() const;  // as JSON
  std::string text(const char* key, std::string otherwise) const;
  /// The numbers of the array `key`, exactly `count` of them, or `otherwise` when missing.
  std::vector<double> numbers(const char* key, std::vector<double> otherwise) const;

  /// An index into something that has `count` items called `items_name`.
  int index(std::size_t count, std::string_view items_name) const;
  int index(const char* key, std::size_t count, std::string_view items_name) const;  // -1 when missing

 private:
  const void* value_;
  std::string place_;
};

/// A parsed JSON text whose root is an object. Refuses syntax errors with line and column, numbers that do
/// not fit a double, nesting deeper than 500, and more than 10 million values.
class JsonDocument {
 public:
  explicit JsonDocument(std::string_view text);
  JsonView root() const { return {value_.get(), ""}; }

 private:
  std::shared_ptr<const void> value_;
};

}  // namespace ukemi::load
