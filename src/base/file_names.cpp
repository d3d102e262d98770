#include "base/file_names.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace ukemi {
namespace {

constexpr std::size_t kMaxBytes = 100;  // leaves room for an extension, a number and a temporary suffix

bool is_plain(unsigned char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-';
}

/// Bytes of the UTF-8 character beyond ASCII that the text begins with; 0 where it is none, is a control
/// character, ends a line or turns the direction of writing.
std::size_t letter_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : std::uint32_t{0};
  };
  const std::size_t length = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4) return 0;
  std::uint32_t code = byte(0) & (0x7Fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3F);
  }
  const bool too_long = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool no_letter = code < 0xA0 || (code >= 0x2028 && code <= 0x202E) ||
                         (code >= 0x2066 && code <= 0x2069) || (code >= 0xD800 && code <= 0xDFFF) ||
                         code > 0x10FFFF;
  return too_long || no_letter ? 0 : length;
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Device names of Windows, whatever follows a dot.
bool is_reserved(const std::string& name) {
  static constexpr std::array<std::string_view, 4> kWords = {"con", "prn", "aux", "nul"};
  const std::string stem = lower(name.substr(0, name.find('.')));
  if (std::find(kWords.begin(), kWords.end(), stem) != kWords.end()) return true;
  return stem.size() == 4 && (stem.starts_with("com") || stem.starts_with("lpt")) && stem[3] >= '0' &&
         stem[3] <= '9';
}

/// At most `bytes`, cut between UTF-8 characters.
std::string shortened(const std::string& text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xc0) == 0x80) --bytes;
  return text.substr(0, bytes);
}

}  // namespace

std::string file_name_from(std::string_view text) {
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t letter = letter_bytes(text.substr(i));
    if (letter > 0)
      name += text.substr(i, letter);
    else if (is_plain(static_cast<unsigned char>(text[i])))
      name += text[i];
    else if (name.empty() || name.back() != '_')
      name += '_';
    if (letter > 0) i += letter - 1;
  }
  if (const std::size_t plain = std::min(name.find_first_not_of("._-"), name.size()); plain > 0)
    name.replace(0, plain, "_");
  name = shortened(name, kMaxBytes);
  while (!name.empty() && (name.back() == '.' || name.back() == '_')) name.pop_back();
  if (name.empty()) return "unnamed";
  return is_reserved(name) ? name + "_" : name;
}

bool is_inside(const std::filesystem::path& path) {
  const std::filesystem::path normal = path.lexically_normal();
  return !normal.empty() && !normal.is_absolute() && *normal.begin() != "..";
}

std::string UniqueNames::take(const std::string& name) {
  std::string free = name;
  for (int i = 2; !taken_.insert(lower(free)).second; ++i) free = name + "_" + std::to_string(i);
  return free;
}

}  // namespace ukemi
