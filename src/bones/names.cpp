#include "bones/names.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <utility>
#include <vector>

namespace ukemi {
namespace {

struct Pattern {
  Part part;
  std::string_view stem;
  int score;
  bool only_end = false;  // the name must mark an end: "Head_end" is the top of the head, "Head" is not
};

// Every naming convention in one table. Higher scores are less ambiguous: "shoulder" is a clavicle beside an
// "arm" (5 + 6 beats 4) and an upper arm below a "collar" (9 + 4 beats 5).
constexpr Pattern kPatterns[] = {
    {Part::pelvis, "pelvis", 10},
    {Part::pelvis, "hips", 9},
    {Part::pelvis, "hip", 8},
    {Part::pelvis, "hippelvis", 9},
    {Part::pelvis, "lowerbody", 6},
    {Part::pelvis, "waist", 2},
    {Part::pelvis, "root", 1},
    {Part::pelvis, "body", 1},

    {Part::spine, "spine", 9},
    {Part::spine, "chest", 9},
    {Part::spine, "upperchest", 9},
    {Part::spine, "abdomen", 9},
    {Part::spine, "torso", 9},
    {Part::spine, "lowerback", 9},
    {Part::spine, "ab", 8},
    {Part::spine, "belly", 7},
    {Part::spine, "waist", 7},
    {Part::spine, "back", 5},
    {Part::spine, "ribcage", 8},
    {Part::spine, "thorax", 8},
    {Part::spine, "upperbody", 8},
    {Part::spine, "lumbar", 8},

    {Part::neck, "neck", 10},
    {Part::neck, "lowerneck", 9},
    {Part::neck, "cervical", 8},
    {Part::head, "head", 10},
    {Part::head, "skull", 6},
    {Part::head, "cranium", 6},
    {Part::head_top, "headtop", 10},
    {Part::head_top, "head", 8, true},
    {Part::head_top, "topofhead", 9},
    {Part::head_top, "skull", 5, true},

    {Part::clavicle, "clavicle", 10},
    {Part::clavicle, "clav", 9},
    {Part::clavicle, "collar", 9},
    {Part::clavicle, "collarbone", 9},
    {Part::clavicle, "shoulder", 5},
    {Part::clavicle, "shldr", 3},
    {Part::clavicle, "innershoulder", 8},
    {Part::clavicle, "shoulderblade", 4},
    {Part::clavicle, "scapula", 3},

    {Part::upper_arm, "upperarm", 10},
    {Part::upper_arm, "uparm", 10},
    {Part::upper_arm, "armupper", 9},
    {Part::upper_arm, "uarm", 9},
    {Part::upper_arm, "humerus", 9},
    {Part::upper_arm, "shldrbend", 8},
    {Part::upper_arm, "arm", 6},
    {Part::upper_arm, "bicep", 5},
    {Part::upper_arm, "biceps", 5},
    {Part::upper_arm, "shoulder", 4},
    {Part::upper_arm, "shldr", 4},

    {Part::forearm, "forearm", 10},
    {Part::forearm, "lowerarm", 10},
    {Part::forearm, "loarm", 10},
    {Part::forearm, "lowarm", 10},
    {Part::forearm, "armlower", 9},
    {Part::forearm, "forearmbend", 9},
    {Part::forearm, "farm", 9},
    {Part::forearm, "elbow", 8},
    {Part::forearm, "radius", 6},
    {Part::forearm, "ulna", 5},

    {Part::hand, "wrist", 10},
    {Part::hand, "hand", 9},
    {Part::hand, "fist", 6},
    {Part::hand, "palm", 5},
    {Part::hand, "fingerbase", 2},

    {Part::finger, "middle", 10},
    {Part::finger, "mid", 9},
    {Part::finger, "handmiddle", 10},
    {Part::finger, "middleproximal", 10},
    {Part::finger, "middlefinger", 10},
    {Part::finger, "fmiddle", 9},
    {Part::finger, "middlehand", 9},
    {Part::finger, "fingers", 8},
    {Part::finger, "handend", 4},
    {Part::finger, "finger", 6},
    {Part::finger, "handindex", 3},
    {Part::finger, "index", 3},

    {Part::thigh, "thigh", 10},
    {Part::thigh, "upleg", 10},
    {Part::thigh, "upperleg", 10},
    {Part::thigh, "legupper", 9},
    {Part::thigh, "thighbend", 9},
    {Part::thigh, "femur", 9},
    {Part::thigh, "hip", 4},
    {Part::thigh, "leg", 3},
    {Part::thigh, "buttock", 1},

    {Part::shank, "shin", 10},
    {Part::shank, "calf", 10},
    {Part::shank, "lowerleg", 10},
    {Part::shank, "lowleg", 10},
    {Part::shank, "loleg", 10},
    {Part::shank, "leglower", 9},
    {Part::shank, "shank", 9},
    {Part::shank, "knee", 8},
    {Part::shank, "tibia", 8},
    {Part::shank, "leg", 5},

    {Part::foot, "foot", 9},
    {Part::foot, "ankle", 10},
    {Part::foot, "feet", 6},

    {Part::toe, "toebase", 10},
    {Part::toe, "toe", 9},
    {Part::toe, "toes", 9},
    {Part::toe, "ball", 9},
    {Part::toe, "foot", 3, true},
    {Part::toe, "toesbase", 9},

    // MikuMikuDance
    {Part::pelvis, "下半身", 6},
    {Part::spine, "上半身", 8},
    {Part::neck, "首", 10},
    {Part::head, "頭", 10},
    {Part::clavicle, "肩", 9},
    {Part::upper_arm, "腕", 9},
    {Part::forearm, "ひじ", 9},
    {Part::hand, "手首", 10},
    {Part::finger, "中指１", 10},
    {Part::finger, "人指１", 3},
    {Part::thigh, "足", 9},
    {Part::shank, "ひざ", 9},
    {Part::foot, "足首", 10},
    {Part::toe, "つま先", 9},
};

constexpr std::string_view kLeft[] = {"l", "left", "lft"};
constexpr std::string_view kRight[] = {"r", "right", "rgt"};
constexpr std::string_view kHelper[] = {
    "ik",         "fk",       "pole",  "poletarget", "target",    "ctrl",   "control",
    "ctl",        "twist",    "roll",  "share",      "mch",       "helper", "locator",
    "goal",       "effector", "eff",   "null",       "footsteps", "pt",     "correctiveroot",
    "corrective", "aim",      "dummy", "wgt",        "vis",       "tweak",  "pivot"};
constexpr std::string_view kEnd[] = {"end", "nub", "tip", "endsite", "site"};
// Prefixes and words that say nothing about the part.
constexpr std::string_view kPrefix[] = {"mixamorig", "bip", "biped", "valve", "cc",   "base",     "def",
                                        "j",         "c",   "b",     "bn",    "sk",   "skel",     "rig",
                                        "m",         "jnt", "bone",  "body",  "char", "character"};
constexpr std::string_view kFiller[] = {"bone", "joint", "jnt", "jt", "org", "jnts"};

bool contains(std::span<const std::string_view> list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
char lowered(char c) { return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c; }

/// Words of a name, lower case: split at separators, at aB, at the last capital of a run (LHip -> l hip) and
/// between letters and digits.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  std::string word;
  const auto flush = [&] {
    if (!word.empty()) words.push_back(std::exchange(word, {}));
  };
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (!is_upper(c) && !is_lower(c) && !is_digit(c)) {
      flush();
      continue;
    }
    if (i > 0 && !word.empty()) {
      const char before = name[i - 1];
      const bool new_word = (is_upper(c) && is_lower(before)) || is_digit(c) != is_digit(before) ||
                            (is_upper(c) && is_upper(before) && i + 1 < name.size() && is_lower(name[i + 1]));
      if (new_word) flush();
    }
    word += lowered(c);
  }
  flush();
  return words;
}

bool is_stem(std::string_view word) {
  return std::any_of(std::begin(kPatterns), std::end(kPatterns),
                     [&](const Pattern& pattern) { return pattern.stem == word; });
}

/// "lefthand" -> left, "hand"; "lhand" -> left, "hand"; "thighl" -> left, "thigh". False when it is no such
/// word.
bool split_side(std::string& word, Side& side) {
  for (const auto& [prefix, s] : {std::pair{std::string_view("left"), Side::left},
                                  {"right", Side::right},
                                  {"左", Side::left},
                                  {"右", Side::right}}) {
    if (word.size() > prefix.size() && word.starts_with(prefix)) {
      word.erase(0, prefix.size());
      side = s;
      return true;
    }
    if (word.size() > prefix.size() && word.ends_with(prefix)) {
      word.resize(word.size() - prefix.size());
      side = s;
      return true;
    }
  }
  // LUArm, RFArm: the second capital belongs to the part.
  if (word == "lu" || word == "lf" || word == "ru" || word == "rf") {
    side = word[0] == 'l' ? Side::left : Side::right;
    word.erase(0, 1);
    return true;
  }
  if (word.size() < 4 || is_stem(word)) return false;
  const std::string_view view = word;
  for (const auto& [letter, s] : {std::pair{'l', Side::left}, {'r', Side::right}}) {
    if (view.front() == letter && is_stem(view.substr(1))) {
      word.erase(0, 1);
      side = s;
      return true;
    }
    if (view.back() == letter && is_stem(view.substr(0, view.size() - 1))) {
      word.pop_back();
      side = s;
      return true;
    }
  }
  return false;
}

int to_int(std::string_view digits) {
  int value = -1;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

}  // namespace

NameReading read_name(std::string_view name) {
  for (const char separator : {':', '|'})
    if (const auto at = name.rfind(separator); at != std::string_view::npos && at + 1 < name.size())
      name.remove_prefix(at + 1);
  NameReading reading;
  if (name.starts_with("__")) ++reading.filler;
  std::vector<std::string> words = words_of(name);
  const auto letters = [](const std::string& word) { return !is_digit(word[0]); };
  const auto count = std::count_if(words.begin(), words.end(), letters);
  auto left = count;
  for (std::string& word : words) {
    if (is_digit(word[0])) {
      if (!reading.stem.empty() && reading.number < 0) reading.number = to_int(word);
      continue;
    }
    --left;
    if (reading.side == Side::none && count > 1 && contains(kLeft, word)) {
      reading.side = Side::left;
    } else if (reading.side == Side::none && count > 1 && contains(kRight, word)) {
      reading.side = Side::right;
    } else if (contains(kHelper, word)) {
      reading.helper = true;
    } else if (contains(kEnd, word)) {
      reading.end = true;
    } else if (reading.stem.empty() && left > 0 && contains(kPrefix, word)) {
      continue;
    } else if (contains(kFiller, word) && (!reading.stem.empty() || left > 0)) {
      ++reading.filler;
    } else {
      if (reading.side == Side::none) split_side(word, reading.side);
      reading.stem += word;
    }
  }
  return reading;
}

int fit(const NameReading& reading, Part part) {
  if (reading.helper) return 0;
  if (reading.end && part != Part::head_top && part != Part::toe) return 0;
  const bool needs_side = part >= Part::clavicle;
  if (needs_side != (reading.side != Side::none)) return 0;
  for (const Pattern& pattern : kPatterns)
    if (pattern.part == part && pattern.stem == reading.stem && (reading.end || !pattern.only_end))
      return std::max(1, pattern.score - reading.filler);
  return 0;
}

std::optional<VrmBone> vrm_bone(std::string_view name) {
  struct Entry {
    std::string_view name;
    Part part;
  };
  static constexpr Entry kSided[] = {
      {"Shoulder", Part::clavicle}, {"UpperArm", Part::upper_arm}, {"LowerArm", Part::forearm},
      {"Hand", Part::hand},         {"UpperLeg", Part::thigh},     {"LowerLeg", Part::shank},
      {"Foot", Part::foot},         {"Toes", Part::toe},           {"MiddleProximal", Part::finger}};
  if (name == "hips") return VrmBone{Part::pelvis, Side::none};
  if (name == "head") return VrmBone{Part::head, Side::none};
  for (const auto& [prefix, side] :
       {std::pair{std::string_view("left"), Side::left}, {"right", Side::right}}) {
    if (!name.starts_with(prefix)) continue;
    for (const Entry& entry : kSided)
      if (name.substr(prefix.size()) == entry.name) return VrmBone{entry.part, side};
  }
  return std::nullopt;
}

}  // namespace ukemi
