#include "layering/layering.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string_view>

namespace ukemi {
namespace {

namespace fs = std::filesystem;

// In the order of the pipeline.
constexpr std::string_view kRooms[] = {"base",    "load",     "bones", "humanoid", "restrict", "body",
                                       "physics", "simulate", "feet",  "behave",   "rise",     "export",
                                       "fbx",     "render",   "clip",  "judge",    "prepare",  "bake",
                                       "check",   "study",    "batch", "review",   "cli"};

// Rooms that never include each other.
const std::vector<std::vector<std::string_view>> kApart = {{"export", "render"},
                                                           {"check", "study", "batch", "review"}};

constexpr long kMostLines = 3600;  // of a room
constexpr std::string_view kLongRoom = "render";

struct ThirdParty {
  std::string_view prefix;              // of the header's name
  std::vector<std::string_view> rooms;  // that may include it; empty: all, headers too
};

const std::vector<ThirdParty>& third_parties() {
  static const std::vector<ThirdParty> table = {
      {"Eigen/", {}},
      {"unsupported/Eigen/", {}},
      {"fmt/", {}},
      {"nlohmann/", {"load", "bones", "export", "clip", "bake", "check", "study", "batch", "review"}},
      {"toml++/", {"bones", "restrict", "body", "prepare", "batch"}},
      {"assimp/", {"load"}},
      {"draco/", {"load"}},
      {"meshoptimizer", {"load"}},
      {"ode/", {"physics"}},
      {"openssl/", {"base"}},
      {"zlib.h", {"fbx"}},
      {"png.h", {"render"}},
      {"webp/", {"render"}},
      {"ft2build.h", {"render"}},
      {"freetype", {"render"}},
      {"stb", {"render"}},
      {"GL/", {"render"}},
      {"EGL/", {"render"}},
      {"CLI/", {"cli"}},
  };
  return table;
}

constexpr std::string_view kSystemHeaders[] = {"dirent.h", "dlfcn.h", "fcntl.h",   "fnmatch.h",
                                               "glob.h",   "poll.h",  "pthread.h", "sched.h",
                                               "signal.h", "spawn.h", "termios.h", "unistd.h"};

struct Include {
  std::string name;
  bool quoted = false;
  int line = 0;
};

std::vector<Include> includes_of(const fs::path& file) {
  static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
  std::vector<Include> includes;
  std::ifstream stream(file);
  std::string text;
  for (int line = 1; std::getline(stream, text); ++line) {
    std::smatch match;
    if (std::regex_match(text, match, pattern)) includes.push_back({match[2], match[1] == "\"", line});
  }
  return includes;
}

struct TypeDefinition {
  std::string place;    // "room/file:line"
  bool shared = false;  // outside an unnamed namespace: one for the whole program
};

using TypesByName = std::map<std::string, std::vector<TypeDefinition>>;

/// The types that a file defines at the top level of its namespaces, which is where lines start without a
/// space.
void find_types(const fs::path& source, const fs::path& file, TypesByName& types) {
  static const std::regex type(
      R"((?:struct|class|union|enum(?: class| struct)?) (\w+)(?: final)?(?: ?:(?!:)[^;]*)?(?: \{.*)?)");
  static const std::regex alias(R"(using (\w+) =.*)");
  std::ifstream stream(file);
  std::string text;
  bool shared = true;
  for (int line = 1; std::getline(stream, text); ++line) {
    if (text.starts_with("namespace {")) shared = false;
    if (text == "}  // namespace") shared = true;
    std::smatch match;
    if (std::regex_match(text, match, type) || std::regex_match(text, match, alias))
      types[match[1]].push_back({fs::relative(file, source).string() + ":" + std::to_string(line), shared});
  }
}

void check_types(const TypesByName& types, LayeringReport& report) {
  for (const auto& [name, definitions] : types) {
    report.types += static_cast<int>(definitions.size());
    if (definitions.size() < 2) continue;
    const auto first =
        std::find_if(definitions.begin(), definitions.end(), [](const auto& d) { return d.shared; });
    if (first == definitions.end()) continue;
    for (const TypeDefinition& other : definitions)
      if (&other != &*first)
        report.violations.push_back(other.place + ": " + name + " is defined in " + first->place + " too");
  }
}

std::optional<std::size_t> rank_of(std::string_view room) {
  const auto found = std::find(std::begin(kRooms), std::end(kRooms), room);
  if (found == std::end(kRooms)) return std::nullopt;
  return static_cast<std::size_t>(found - std::begin(kRooms));
}

bool are_apart(std::string_view a, std::string_view b) {
  const auto holds = [](const std::vector<std::string_view>& rooms, std::string_view room) {
    return std::find(rooms.begin(), rooms.end(), room) != rooms.end();
  };
  return a != b && std::any_of(kApart.begin(), kApart.end(),
                               [&](const auto& rooms) { return holds(rooms, a) && holds(rooms, b); });
}

bool is_standard_or_system(const std::string& header) {
  if (header.starts_with("sys/")) return true;
  if (std::find(std::begin(kSystemHeaders), std::end(kSystemHeaders), header) != std::end(kSystemHeaders))
    return true;
  return header.find_first_of("./") == std::string::npos;
}

/// What is wrong with `include` in a file of `room`, or nothing.
std::optional<std::string> violation(const fs::path& source, const std::string& room, bool is_header,
                                     const Include& include) {
  for (const ThirdParty& party : third_parties()) {
    if (!include.name.starts_with(party.prefix)) continue;
    if (party.rooms.empty()) return std::nullopt;
    if (std::find(party.rooms.begin(), party.rooms.end(), room) == party.rooms.end())
      return room + " must not include " + include.name;
    if (is_header) return "a header must not include " + include.name;
    return std::nullopt;
  }
  if (!include.quoted) {
    if (is_standard_or_system(include.name)) return std::nullopt;
    return "unknown header " + include.name;
  }
  const std::string target = include.name.substr(0, include.name.find('/'));
  const std::optional<std::size_t> target_rank = rank_of(target);
  if (!target_rank) return "name " + include.name + " by its room's folder";
  if (!fs::exists(source / include.name)) return include.name + " does not exist";
  if (*target_rank > *rank_of(room) || are_apart(room, target))
    return room + " must not include " + include.name;
  return std::nullopt;
}

using Modules = std::map<std::string, std::set<std::string>>;  // a module and those that it includes

std::string module_of(const fs::path& file) { return fs::path(file).replace_extension().generic_string(); }

/// The way from `module` along includes back to itself, through modules that come after it by name; empty
/// where there is none.
std::vector<std::string> cycle_from(const Modules& modules, const std::string& module) {
  std::map<std::string, std::string> reached_from;
  std::vector<std::string> open{module};
  for (std::size_t i = 0; i < open.size(); ++i) {
    const auto found = modules.find(open[i]);
    if (found == modules.end()) continue;
    for (const std::string& next : found->second) {
      if (next < module || reached_from.count(next) > 0) continue;
      reached_from[next] = open[i];
      if (next != module) open.push_back(next);
    }
  }
  std::vector<std::string> way;
  if (reached_from.count(module) == 0) return way;
  for (std::string at = reached_from[module]; at != module; at = reached_from[at]) way.push_back(at);
  std::reverse(way.begin(), way.end());
  return way;
}

/// Each cycle is told once, at the module that comes first by name.
void check_cycles(const Modules& modules, LayeringReport& report) {
  std::set<std::string> told;
  for (const auto& [module, includes] : modules) {
    const std::vector<std::string> way = cycle_from(modules, module);
    if (way.empty() || told.count(module) > 0) continue;
    std::string text = module + ": includes itself by way of";
    for (const std::string& at : way) text += " " + at;
    report.violations.push_back(text);
    told.insert(way.begin(), way.end());
  }
}

void check_lengths(const std::map<std::string, long>& lines, LayeringReport& report) {
  for (const auto& [room, count] : lines)
    if (count > kMostLines && room != kLongRoom)
      report.violations.push_back(room + ": " + std::to_string(count) + " lines are more than " +
                                  std::to_string(kMostLines));
}

long lines_of(const fs::path& file) {
  std::ifstream stream(file);
  std::string text;
  long lines = 0;
  while (std::getline(stream, text)) ++lines;
  return lines;
}

void check_file(const fs::path& source, const fs::path& file, LayeringReport& report) {
  const fs::path relative = fs::relative(file, source);
  const std::string extension = file.extension().string();
  const std::string room = relative.begin()->string();
  if (extension == ".txt" || extension == ".md" || extension == ".in" || extension == ".cmake") return;
  if (extension != ".h" && extension != ".cpp") {
    report.violations.push_back(relative.string() + ": is neither .h nor .cpp");
    return;
  }
  if (!rank_of(room)) {
    report.violations.push_back(relative.string() + ": " + room + " is not a known room");
    return;
  }
  ++report.files;
  for (const Include& include : includes_of(file)) {
    ++report.includes;
    if (const auto what = violation(source, room, extension == ".h", include))
      report.violations.push_back(relative.string() + ":" + std::to_string(include.line) + ": " + *what);
  }
}

bool is_source(const fs::path& file) { return file.extension() == ".h" || file.extension() == ".cpp"; }

/// The .h and .cpp files below a folder, by name.
std::vector<fs::path> sources_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (auto entry = fs::recursive_directory_iterator(folder); entry != fs::end(entry); ++entry) {
    const fs::path name = entry->path().filename();
    if (name == "node_modules" || name == "build")
      entry.disable_recursion_pending();
    else if (entry->is_regular_file() && is_source(entry->path()))
      files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::vector<std::string> foreign_random_numbers(const fs::path& folder) {
  static const std::regex foreign(
      R"(#\s*include\s*<random>|\bstd::(mt19937|minstd_rand|random_device|\w+_distribution|shuffle)|)"
      R"(\bs?rand\(|::Random\()");
  std::vector<std::string> places;
  for (const fs::path& file : sources_below(folder)) {
    std::ifstream stream(file);
    std::string text;
    for (int line = 1; std::getline(stream, text); ++line) {
      std::smatch match;
      if (std::regex_search(text, match, foreign))
        places.push_back(fs::relative(file, folder).string() + ":" + std::to_string(line) + ": " +
                         match.str() + ": take base/random.h");
    }
  }
  return places;
}

LayeringReport check_layering(const fs::path& source) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(source))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  LayeringReport report;
  TypesByName types;
  Modules modules;
  std::map<std::string, long> lines;
  for (const fs::path& file : files) {
    check_file(source, file, report);
    if (!is_source(file)) continue;
    find_types(source, file, types);
    const fs::path relative = fs::relative(file, source);
    lines[relative.begin()->string()] += lines_of(file);
    for (const Include& include : includes_of(file))
      if (include.quoted && module_of(include.name) != module_of(relative))
        modules[module_of(relative)].insert(module_of(include.name));
  }
  check_types(types, report);
  check_cycles(modules, report);
  check_lengths(lines, report);
  return report;
}

}  // namespace ukemi
