#include <algorithm>
#include <filesystem>

#include "base/errors.h"
#include "base/files.h"
#include "base/nearest.h"
#include "cli/commands.h"
#include "cli/console.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxBytes = 1 << 20;

/// Names of the pages in assets/help, in order.
std::vector<std::string> topics() {
  std::vector<std::string> names;
  const auto folder = find_asset("help");
  if (!folder) return names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(*folder, error))
    if (entry.path().extension() == ".md") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

int help_command(const Arguments& arguments) {
  if (arguments.empty() || arguments.front() == "--help") return run({"--help"});
  if (arguments.size() > 1)
    return print_error(usage_error("more than one topic", "ask for one of them: ukemi help TOPIC"));
  const std::string& topic = arguments.front();
  const std::vector<std::string> known = topics();
  if (std::find(known.begin(), known.end(), topic) == known.end())
    return print_error(usage_error("no page '" + topic + "'", suggestion(topic, known)));
  const auto page = find_asset("help/" + topic + ".md");
  if (!page) return print_error(page.error());
  const auto bytes = read_file(*page, kMaxBytes);
  if (!bytes) return print_error(bytes.error());
  return print_result(std::string(bytes->begin(), bytes->end()), 0);
}

}  // namespace ukemi
