#include "batch/recipe.h"

#include <fmt/format.h>
#include <fnmatch.h>
#include <glob.h>
#include <toml++/toml.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>

#include "base/errors.h"
#include "base/file_names.h"
#include "base/files.h"
#include "base/nearest.h"
#include "prepare/setting_table.h"
#include "restrict/region_tables.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxBytes = 4u << 20;
constexpr int kMaxVariations = 10000;
constexpr std::int64_t kMaxSeed = std::int64_t{1} << 53;

const std::vector<std::string> kTopKeys = {"format",   "characters", "outputs", "name",   "seed",
                                           "settings", "character",  "joint",   "matrix", "reaction"};
const std::vector<std::string> kMatrixKeys = {"name", "characters", "outputs", "variations", "jitter"};
const std::vector<std::string> kJitterKeys = {"direction-deg", "point-m", "strength-percent"};
const std::vector<std::pair<std::string, OutputKind>> kOutputWords = {
    {"glb", OutputKind::glb},       {"gltf", OutputKind::gltf},    {"fbx", OutputKind::fbx},
    {"vrma", OutputKind::vrma},     {"bvh", OutputKind::bvh},      {"sheet", OutputKind::sheet},
    {"report", OutputKind::report}, {"events", OutputKind::events}};

/// Faults inside the reader, turned into results at its edge.
struct Fault {
  Error error;
};

struct Entry {
  std::string key;
  toml::source_position at;
  const toml::node* node;
};

/// The keys of a table in the order of the file.
std::vector<Entry> entries_of(const toml::table& table) {
  std::vector<Entry> entries;
  for (auto&& [key, node] : table) entries.push_back({std::string(key.str()), key.source().begin, &node});
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.at < b.at; });
  return entries;
}

std::string_view type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

std::vector<std::string> setting_names() {
  std::vector<std::string> names;
  for (const Setting& setting : bake_settings()) {
    names.emplace_back(setting.name);
    names.insert(names.end(), setting.also.begin(), setting.also.end());
  }
  return names;
}

const Setting* setting_named(std::string_view name) {
  const auto found = find_setting(name);
  return found ? *found : nullptr;
}

/// Whether the setting takes some numbers, though it is text: a direction, a unit.
bool is_text_or_number(const Setting& setting, const std::string& number) {
  BakeSettings scratch;
  return setting.kind == Setting::Kind::text && setting.set(scratch, number) && !setting.set(scratch, "\x01");
}

/// Settings that may name a file say so in their placeholder.
bool may_be_file(const Setting& setting) { return setting.value.find("FILE") != std::string::npos; }

/// Reads one recipe; the first fault stops it.
class RecipeReader {
 public:
  RecipeReader(const fs::path& file, toml::table document)
      : file_(file.string()),
        folder_(file.parent_path()),
        document_(std::make_shared<const toml::table>(std::move(document))) {}

  Recipe read() {
    const toml::table& table = *document_;
    recipe_.file = file_;
    for (const Entry& entry : entries_of(table))
      if (std::find(kTopKeys.begin(), kTopKeys.end(), entry.key) == kTopKeys.end())
        fail(entry.at, fmt::format("unknown key '{}'", entry.key), near_top_key(entry.key));
    read_format(table);
    read_seed(table);
    read_characters(table);
    if (const toml::node* node = table.get("settings")) recipe_.settings = read_settings(*node, {});
    read_character_tables(table);
    take_limits();
    outputs_ = {OutputKind::glb, OutputKind::sheet, OutputKind::report};
    if (const toml::node* node = table.get("outputs")) outputs_ = read_outputs(*node);
    if (const toml::node* node = table.get("name")) pattern_ = text_of(*node, "name");
    read_matrices(table);
    return std::move(recipe_);
  }

 private:
  [[noreturn]] void fail(const toml::source_position& at, std::string what, std::string fix,
                         ErrorKind kind = ErrorKind::usage) const {
    throw Fault{{kind, file_, static_cast<int>(at.line), static_cast<int>(at.column), "", std::move(what),
                 std::move(fix)}};
  }
  [[noreturn]] void fail(const toml::node& node, std::string what, std::string fix) const {
    fail(node.source().begin, std::move(what), std::move(fix));
  }

  /// A setting at the top is the commonest slip: it says where settings go.
  std::string near_top_key(const std::string& key) const {
    if (setting_named(key))
      return fmt::format("write '{}' below [settings], [[matrix]] or [[reaction]]", key);
    return suggestion(key, kTopKeys);
  }

  std::string text_of(const toml::node& node, std::string_view key) const {
    if (const auto text = node.value_exact<std::string>()) return *text;
    fail(node, fmt::format("'{}' is {}, not a text", key, type_name(node)), "write it in \"quotes\"");
  }

  std::vector<std::pair<std::string, const toml::node*>> texts_of(const toml::node& node,
                                                                  std::string_view key) const {
    const toml::array* array = node.as_array();
    if (!array || array->empty())
      fail(node, fmt::format("'{}' is not an array of texts", key), fmt::format("write {} = [\"...\"]", key));
    std::vector<std::pair<std::string, const toml::node*>> texts;
    for (const toml::node& element : *array) texts.emplace_back(text_of(element, key), &element);
    return texts;
  }

  std::int64_t whole_of(const toml::node& node, std::string_view key, std::int64_t low,
                        std::int64_t high) const {
    const auto number = node.value_exact<std::int64_t>();
    if (!number || *number < low || *number > high)
      fail(node, fmt::format("'{}' is not a whole number from {} to {}", key, low, high),
           fmt::format("write a whole number from {} to {}", low, high));
    return *number;
  }

  void read_format(const toml::table& table) {
    const toml::node* node = table.get("format");
    if (!node) fail(table, "'format' is missing", "begin the recipe with format = 1");
    if (node->value_exact<std::int64_t>() != 1)
      fail(*node, "'format' is not one that this program knows", "write format = 1");
  }

  void read_seed(const toml::table& table) {
    if (const toml::node* node = table.get("seed"))
      recipe_.seed = static_cast<std::uint64_t>(whole_of(*node, "seed", 0, kMaxSeed));
  }

  /// Files that a pattern names, relative to the recipe's folder, sorted.
  std::vector<std::string> matches(const std::string& pattern) const {
    const std::string base = folder_.empty() ? "" : folder_.string() + "/";
    const bool absolute = fs::path(pattern).is_absolute();
    glob_t found{};
    std::vector<std::string> files;
    if (glob((absolute ? pattern : escaped(base) + pattern).c_str(), GLOB_NOSORT, nullptr, &found) == 0)
      for (std::size_t i = 0; i < found.gl_pathc; ++i) {
        std::error_code error;
        if (fs::is_regular_file(found.gl_pathv[i], error))
          files.push_back(std::string(found.gl_pathv[i]).substr(absolute ? 0 : base.size()));
      }
    globfree(&found);
    std::sort(files.begin(), files.end());
    return files;
  }

  static std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
      if (c == '*' || c == '?' || c == '[' || c == '\\') result += '\\';
      result += c;
    }
    return result;
  }

  void read_characters(const toml::table& table) {
    const toml::node* node = table.get("characters");
    if (!node) fail(table, "'characters' is missing", "write characters = [\"mannequin\"], or your files");
    std::set<std::string> known;
    UniqueNames names;
    for (const auto& [pattern, where] : texts_of(*node, "characters")) {
      const bool builtin = pattern == "mannequin";
      const std::vector<std::string> files = builtin ? std::vector{pattern} : matches(pattern);
      if (files.empty())
        fail(*where, fmt::format("no file matches '{}'", pattern),
             "name files relative to the recipe's folder; * and ? stand for parts of a name");
      for (const std::string& file : files) {
        if (!known.insert(file).second) continue;
        const std::string path = builtin ? file : (folder_ / file).string();
        const std::string stem = builtin ? file : fs::path(file).stem().string();
        recipe_.characters.push_back({names.take(file_name_from(stem)), file, path, {}, {}});
      }
    }
  }

  /// Characters that a word names: the file as the recipe finds it, its name alone, or a pattern of either.
  std::vector<std::size_t> characters_named(const std::string& word) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < recipe_.characters.size(); ++i) {
      const RecipeCharacter& character = recipe_.characters[i];
      const std::string file_name = fs::path(character.written).filename().string();
      for (const std::string& name : {character.written, file_name, character.name}) {
        if (fnmatch(word.c_str(), name.c_str(), FNM_PERIOD) != 0) continue;
        found.push_back(i);
        break;
      }
    }
    return found;
  }

  std::vector<std::size_t> need_characters(const std::string& word, const toml::source_position& at) const {
    std::vector<std::size_t> found = characters_named(word);
    if (!found.empty()) return found;
    std::vector<std::string> names;
    for (const RecipeCharacter& character : recipe_.characters) names.push_back(character.written);
    fail(at, fmt::format("no character is named '{}'", word), suggestion(word, names));
  }

  /// Text of one value as its setting takes it; what the setting refuses is told at the value's place.
  std::string value_text(const Setting& setting, const toml::node& node) const {
    using Kind = Setting::Kind;
    std::string text;
    bool right_type = false;
    if (const auto number = node.value<double>(); number && node.is_number()) {
      text = node.is_integer() ? fmt::format("{}", *node.value<std::int64_t>()) : fmt::format("{}", *number);
      right_type = setting.kind == Kind::number || is_text_or_number(setting, text);
    } else if (const auto word = node.value_exact<std::string>()) {
      text = *word;
      right_type = setting.kind != Kind::number && setting.kind != Kind::on_off;
    } else if (const auto truth = node.value_exact<bool>()) {
      text = *truth ? "true" : "false";
      right_type = setting.kind == Kind::on_off;
    }
    if (!right_type)
      fail(node, fmt::format("'{}' is {}", setting.name, type_name(node)), wanted_type(setting));
    if (may_be_file(setting)) text = beside_recipe(text);
    BakeSettings scratch;
    if (const Status status = setting.set(scratch, text); !status)
      fail(node, fmt::format("'{}': {}", setting.name, status.error().what), status.error().fix);
    return text;
  }

  static std::string wanted_type(const Setting& setting) {
    switch (setting.kind) {
      case Setting::Kind::number:
        return "give a number, " + setting.range.text();
      case Setting::Kind::on_off:
        return "give true or false";
      case Setting::Kind::choice:
        return fmt::format("give one of \"{}\"", fmt::join(setting.words, "\" \""));
      default:
        return fmt::format("give a text in \"quotes\": {}", setting.value);
    }
  }

  /// The path of a file beside the recipe; any other text as it is.
  std::string beside_recipe(const std::string& text) const {
    std::error_code error;
    const fs::path path = folder_ / text;
    return !text.empty() && fs::is_regular_file(path, error) ? path.string() : text;
  }

  RecipeValue value_of(const Setting& setting, const toml::node& node) const {
    const toml::source_position at = node.source().begin;
    RecipeValue value{{}, static_cast<int>(at.line), static_cast<int>(at.column)};
    if (setting.kind != Setting::Kind::list) {
      value.texts.push_back(value_text(setting, node));
      return value;
    }
    const toml::array* array = node.as_array();
    if (!array)
      fail(node, fmt::format("'{}' is {}", setting.name, type_name(node)),
           fmt::format("write {} = [\"{}\"]", setting.name, setting.value));
    for (const toml::node& element : *array) value.texts.push_back(value_text(setting, element));
    return value;
  }

  const Setting& need_setting(const Entry& entry, const std::vector<std::string>& other_keys) const {
    if (const Setting* setting = setting_named(entry.key)) return *setting;
    std::vector<std::string> known = setting_names();
    known.insert(known.end(), other_keys.begin(), other_keys.end());
    const std::string near = nearest_word(entry.key, known);
    fail(entry.at, fmt::format("unknown setting '{}'", entry.key),
         near.empty() ? "ukemi recipe prints all settings" : fmt::format("did you mean '{}'?", near));
  }

  /// "pre-roll" and "lead" are one setting: it may stand in a table once.
  void check_given_once(bool given, const Entry& entry, const Setting& setting) const {
    if (given)
      fail(entry.at, fmt::format("'{}' is set twice, under two names", entry.key),
           fmt::format("write {} once", setting.shown()));
  }

  RecipeSettings read_settings(const toml::node& node, const std::vector<std::string>& other_keys) const {
    const toml::table* table = node.as_table();
    if (!table) fail(node, "settings are not a table", "write [settings] and a line for each setting below");
    RecipeSettings settings;
    for (const Entry& entry : entries_of(*table)) {
      if (std::find(other_keys.begin(), other_keys.end(), entry.key) != other_keys.end()) continue;
      const Setting& setting = need_setting(entry, other_keys);
      if (entry.node->is_array() && setting.kind != Setting::Kind::list)
        fail(*entry.node, fmt::format("'{}' has several values here", entry.key),
             "several values make a matrix: write them below [[matrix]]");
      const std::string name(setting.name);
      check_given_once(settings.contains(name), entry, setting);
      settings[name] = value_of(setting, *entry.node);
    }
    return settings;
  }

  void read_character_tables(const toml::table& document) {
    const toml::node* node = document.get("character");
    if (!node) return;
    const toml::table* table = node->as_table();
    if (!table) fail(*node, "'character' is not a table", "write [character.\"hero.glb\"]");
    for (const Entry& entry : entries_of(*table)) {
      const std::vector<std::size_t> named = need_characters(entry.key, entry.at);
      const RecipeSettings settings = read_settings(*entry.node, {"joint"});
      for (const std::size_t i : named)
        for (const auto& [name, value] : settings) recipe_.characters[i].settings[name] = value;
    }
  }

  const toml::array* joints_of(const toml::node* node) const {
    if (!node) return nullptr;
    const toml::array* joints = node->as_array();
    if (!joints)
      fail(*node, "'joint' is not an array of tables", "write [[joint]] and the joint's keys below");
    return joints;
  }

  /// Joints of the recipe, then of each table that names the character. Tried on the human range, so that
  /// faults are found here.
  void take_limits() {
    const toml::table& document = *document_;
    const auto human = load_range_of_motion("human");
    if (!human) throw Fault{human.error()};
    const toml::table* tables = document["character"].as_table();
    for (std::size_t i = 0; i < recipe_.characters.size(); ++i) {
      std::vector<const toml::array*> changes;
      if (const toml::array* joints = joints_of(document.get("joint"))) changes.push_back(joints);
      for (const Entry& entry : tables ? entries_of(*tables) : std::vector<Entry>()) {
        const std::vector<std::size_t> named = characters_named(entry.key);
        if (std::find(named.begin(), named.end(), i) == named.end()) continue;
        if (const toml::array* joints = joints_of(entry.node->as_table()->get("joint")))
          changes.push_back(joints);
      }
      if (changes.empty()) continue;
      auto& limits = recipe_.characters[i].limits;
      limits = [changes, document = document_, file = file_](RangeOfMotion range) -> Result<RangeOfMotion> {
        for (const toml::array* joints : changes) {
          auto changed = with_joint_tables(std::move(range), *joints, file);
          if (!changed) return changed;
          range = std::move(*changed);
        }
        return range;
      };
      if (const auto tried = limits(*human); !tried) throw Fault{tried.error()};
    }
  }

  std::vector<OutputKind> read_outputs(const toml::node& node) const {
    std::vector<std::string> words;
    for (const auto& output : kOutputWords) words.push_back(output.first);
    std::set<OutputKind> kinds;
    for (const auto& [text, where] : texts_of(node, "outputs")) {
      const auto found =
          std::find_if(kOutputWords.begin(), kOutputWords.end(),
                       [&wanted = text](const auto& output) { return output.first == wanted; });
      if (found == kOutputWords.end())
        fail(*where, fmt::format("unknown output '{}'", text), suggestion(text, words));
      kinds.insert(found->second);
    }
    return {kinds.begin(), kinds.end()};
  }

  Jitter read_jitter(const toml::node& node) const {
    const toml::table* table = node.as_table();
    if (!table) fail(node, "'jitter' is not a table", "write jitter = { direction-deg = 10 }");
    const Range degrees_range{0.0, 180.0}, metres_range{0.0, 1.0}, percent_range{0.0, 90.0};
    Jitter jitter;
    for (const Entry& entry : entries_of(*table)) {
      const auto number = entry.node->is_number() ? entry.node->value<double>() : std::nullopt;
      const auto take = [&](double& target, const Range& range) {
        if (!number || !range.contains(*number))
          fail(*entry.node, fmt::format("jitter of '{}' is not a number, {}", entry.key, range.text()),
               "give a number, " + range.text());
        target = *number;
      };
      if (entry.key == kJitterKeys[0])
        take(jitter.direction_deg, degrees_range);
      else if (entry.key == kJitterKeys[1])
        take(jitter.point_m, metres_range);
      else if (entry.key == kJitterKeys[2])
        take(jitter.strength_percent, percent_range);
      else
        fail(entry.at, fmt::format("unknown jitter '{}'", entry.key), suggestion(entry.key, kJitterKeys));
    }
    return jitter;
  }

  std::vector<std::size_t> read_matrix_characters(const toml::node& node) const {
    std::set<std::size_t> chosen;
    for (const auto& [word, where] : texts_of(node, "characters"))
      for (const std::size_t i : need_characters(word, where->source().begin)) chosen.insert(i);
    return {chosen.begin(), chosen.end()};
  }

  /// The settings and axes of a [[matrix]]; arrays are axes.
  void read_axes(const toml::table& table, RecipeMatrix& matrix, bool may_have_axes) const {
    for (const Entry& entry : entries_of(table)) {
      if (std::find(kMatrixKeys.begin(), kMatrixKeys.end(), entry.key) != kMatrixKeys.end()) continue;
      const Setting& setting = need_setting(entry, kMatrixKeys);
      const std::string name(setting.name);
      const bool given =
          matrix.settings.contains(name) || std::any_of(matrix.axes.begin(), matrix.axes.end(),
                                                        [&](const auto& axis) { return axis.first == name; });
      check_given_once(given, entry, setting);
      const toml::array* values = entry.node->as_array();
      if (!values || setting.kind == Setting::Kind::list) {
        matrix.settings[name] = value_of(setting, *entry.node);
        continue;
      }
      if (!may_have_axes)
        fail(*entry.node, fmt::format("'{}' has several values", entry.key),
             "several values make a matrix: write [[matrix]] in place of [[reaction]]");
      if (values->empty())
        fail(*entry.node, fmt::format("'{}' has no values", entry.key), "give at least one value");
      matrix.axes.push_back({name, {}});
      for (const toml::node& value : *values) matrix.axes.back().second.push_back(value_of(setting, value));
    }
  }

  std::string default_pattern(const RecipeMatrix& matrix) const {
    std::string pattern = "{hit}_{from}";
    for (const auto& axis : matrix.axes)
      if (axis.first != "hit" && axis.first != "from") pattern += fmt::format("_{{{}}}", axis.first);
    return matrix.variations > 1 ? pattern + "_{variation}" : pattern;
  }

  /// Names in braces are settings, variation or character.
  void check_pattern(const std::string& pattern, const toml::node& where) const {
    std::vector<std::string> known = setting_names();
    known.insert(known.end(), {"variation", "character"});
    for (std::size_t open = pattern.find('{'); open != pattern.npos; open = pattern.find('{', open + 1)) {
      const std::size_t close = pattern.find('}', open);
      if (close == pattern.npos) fail(where, "the name has a { without }", "write {hit}, {from} and so on");
      const std::string word = pattern.substr(open + 1, close - open - 1);
      if (std::find(known.begin(), known.end(), word) == known.end())
        fail(where, fmt::format("the name has an unknown part '{{{}}}'", word), suggestion(word, known));
    }
  }

  RecipeMatrix read_matrix(const toml::node& node, bool may_have_axes) const {
    const toml::table* table = node.as_table();
    if (!table) fail(node, "is not a table", "write [[matrix]] and its keys below");
    RecipeMatrix matrix;
    matrix.outputs = outputs_;
    for (std::size_t i = 0; i < recipe_.characters.size(); ++i) matrix.characters.push_back(i);
    if (const toml::node* chosen = table->get("characters"))
      matrix.characters = read_matrix_characters(*chosen);
    if (const toml::node* outputs = table->get("outputs")) matrix.outputs = read_outputs(*outputs);
    if (const toml::node* count = table->get("variations"))
      matrix.variations = static_cast<int>(whole_of(*count, "variations", 1, kMaxVariations));
    if (const toml::node* jitter = table->get("jitter")) matrix.jitter = read_jitter(*jitter);
    read_axes(*table, matrix, may_have_axes);
    matrix.name = pattern_ && may_have_axes ? *pattern_ : default_pattern(matrix);
    if (const toml::node* name = table->get("name")) {
      matrix.name = text_of(*name, "name");
      check_pattern(matrix.name, *name);
    }
    return matrix;
  }

  void read_matrices(const toml::table& table) {
    if (pattern_) check_pattern(*pattern_, *table.get("name"));
    std::vector<std::pair<toml::source_position, RecipeMatrix>> found;
    for (const char* key : {"matrix", "reaction"}) {
      const toml::node* node = table.get(key);
      if (!node) continue;
      const toml::array* array = node->as_array();
      if (!array || !array->is_array_of_tables())
        fail(*node, fmt::format("'{}' is not an array of tables", key), fmt::format("write [[{}]]", key));
      for (const toml::node& element : *array)
        found.emplace_back(element.source().begin, read_matrix(element, std::string_view(key) == "matrix"));
    }
    if (found.empty()) fail(table, "has neither [[matrix]] nor [[reaction]]", "add one; see ukemi recipe");
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (auto& matrix : found) recipe_.matrices.push_back(std::move(matrix.second));
  }

  std::string file_;
  fs::path folder_;
  std::shared_ptr<const toml::table> document_;  // kept by what `limits` reads of it: copies have no lines
  Recipe recipe_;
  std::vector<OutputKind> outputs_;
  std::optional<std::string> pattern_;
};

}  // namespace

std::string_view extension(OutputKind kind) {
  switch (kind) {
    case OutputKind::glb:
      return ".glb";
    case OutputKind::gltf:
      return ".gltf";
    case OutputKind::fbx:
      return ".fbx";
    case OutputKind::vrma:
      return ".vrma";
    case OutputKind::bvh:
      return ".bvh";
    case OutputKind::sheet:
      return ".png";
    case OutputKind::events:
      return ".events.json";
    case OutputKind::report:
      break;
  }
  return ".json";
}

Result<Recipe> parse_recipe(std::string_view toml, const fs::path& file) {
  try {
    return RecipeReader(file, toml::parse(toml, file.string())).read();
  } catch (const Fault& fault) {
    return fault.error;
  } catch (const toml::parse_error& error) {
    return error_at(error.source().begin,
                    usage_error(file, std::string(error.description()), "correct the TOML syntax"));
  }
}

Result<Recipe> load_recipe(const fs::path& file) {
  const auto bytes = read_file(file, kMaxBytes);
  if (!bytes) return bytes.error();
  return parse_recipe(std::string_view(reinterpret_cast<const char*>(bytes->data()), bytes->size()), file);
}

}  // namespace ukemi
