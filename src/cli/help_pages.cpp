#include "cli/help_pages.h"

#include <algorithm>
#include <filesystem>

#include "base/files.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxBytes = 1 << 20;

}  // namespace

std::vector<std::string> help_topics() {
  std::vector<std::string> names;
  const auto folder = find_asset("help");
  if (!folder) return names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(*folder, error))
    if (entry.path().extension() == ".md") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

Result<std::string> help_page(const std::string& topic) {
  const auto file = find_asset("help/" + topic + ".md");
  if (!file) return file.error();
  const auto bytes = read_file(*file, kMaxBytes);
  if (!bytes) return bytes.error();
  return std::string(bytes->begin(), bytes->end());
}

std::string title_of(const std::string& page) {
  const std::size_t begin = std::min(page.find_first_not_of("# "), page.size());
  return page.substr(begin, page.find('\n', begin) - begin);
}

}  // namespace ukemi
