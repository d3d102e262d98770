#include "bake/file_names.h"

#include <algorithm>
#include <array>

namespace ukemi {
namespace {

constexpr std::size_t kMaxBytes = 100;  // leaves room for an extension, a number and a temporary suffix

bool is_plain(unsigned char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
         c >= 0x80;
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
  for (const char c : text) {
    if (is_plain(static_cast<unsigned char>(c)))
      name += c;
    else if (name.empty() || name.back() != '_')
      name += '_';
  }
  if (const std::size_t plain = std::min(name.find_first_not_of("._-"), name.size()); plain > 0)
    name.replace(0, plain, "_");
  name = shortened(name, kMaxBytes);
  while (!name.empty() && (name.back() == '.' || name.back() == '_')) name.pop_back();
  if (name.empty()) return "unnamed";
  return is_reserved(name) ? name + "_" : name;
}

std::string UniqueNames::take(const std::string& name) {
  std::string free = name;
  for (int i = 2; !taken_.insert(lower(free)).second; ++i) free = name + "_" + std::to_string(i);
  return free;
}

}  // namespace ukemi
