#include "base/csv.h"

#include <string_view>

namespace ukemi {
namespace {

/// Quoted where RFC 4180 asks for it.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + "\"";
}

/// Spreadsheets run what begins so.
std::string harmless(const std::string& text) {
  return !text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos
             ? "'" + text
             : text;
}

}  // namespace

std::string csv_text(const std::string& text) { return quoted(harmless(text)); }

}  // namespace ukemi
