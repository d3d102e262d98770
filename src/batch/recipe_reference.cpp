// The commented recipe that `ukemi recipe` prints, made from the table of settings.
#include <fmt/format.h>

#include <algorithm>

#include "batch/recipe.h"
#include "prepare/setting_table.h"

namespace ukemi {
namespace {

constexpr std::size_t kWidth = 100;

constexpr const char* kHead = R"(## A recipe: many reactions in one file. Bake it with
##   ukemi batch RECIPE.toml -o FOLDER
## Lines with two # explain. Lines with one # are the defaults, or examples: take the # away and change them.
## Each setting has the name of its option of `ukemi bake`. Where several places give the same one, the later
## of these wins: the program's default, [settings], [character."..."], the [[matrix]] or [[reaction]], the
## values of a matrix.

format = 1

## Files beside this one; * and ? stand for parts of a name. "mannequin" is the program's own character.
characters = ["mannequin"]

## What each reaction gets: glb gltf fbx vrma bvh, a sheet (contact sheet, .png), a report (.json),
## events (when what happens, .events.json).
outputs = ["glb", "sheet", "report"]

## Name of the files and clips of matrices: any setting in braces, {variation}, {character}. The default has
## {hit}_{from} and whatever else the matrix varies. What a file system would not take becomes _, and a name
## that comes twice gets a number.
# name = "{hit}_{from}_{preset}"

## Another seed gives other variations. 0 to 9007199254740992.
# seed = 0

## Every combination of the values: here 2 segments x 4 sides = 8 reactions of each character. Any setting may
## have several values; single values hold for the whole matrix. There may be many matrices.
[[matrix]]
hit = ["head", "torso"]
from = ["front", "back", "left", "right"]
preset = "punch"
## Takes of each combination, and how far they differ from what is written, at random, either way: degrees of
## azimuth and elevation, metres on the segment, percent of the momentum.
# variations = 3
# jitter = { direction-deg = 10, point-m = 0.03, strength-percent = 15 }
## Also: name, outputs, and characters (those that get this matrix).
# outputs = ["glb", "bvh"]
# characters = ["mannequin"]

## A single one.
# [[reaction]]
# name = "shoved"
# hit = "torso"
# from = "back"
# preset = "tackle"

## What holds for one character only: its file as above, or a pattern.
# [character."mannequin"]
# mass = 80

## The range of motion of single joints: keys of a region file (assets/limits/human.toml), degrees, one side
## at a time. Below [[character."..."]] write [[character."hero.glb".joint]].
# [[joint]]
# name = "elbow_l"
# alpha = [-10, 10]

## What holds for all reactions.
# [settings]
)";

std::string toml_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

std::string toml_value(const Setting& setting, const std::string& text) {
  const bool bare = setting.kind == Setting::Kind::number || setting.kind == Setting::Kind::on_off;
  return bare ? text : toml_text(text);
}

/// "## " lines of at most kWidth.
std::string explained(const std::string& text) {
  std::string lines = "##", line;
  std::size_t column = 2;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (column + 1 + (end - begin) > kWidth) {
      lines += "\n##";
      column = 2;
    }
    lines += " " + text.substr(begin, end - begin);
    column += 1 + (end - begin);
    begin = end + 1;
  }
  return lines + "\n";
}

std::string legal(const Setting& setting) {
  if (setting.kind == Setting::Kind::number) return setting.range.text();
  if (setting.kind == Setting::Kind::choice) return fmt::format("{}", fmt::join(setting.words, " "));
  return "";
}

std::string reference_of(const Setting& setting) {
  const std::vector<std::string> values = setting.get(BakeSettings());
  const bool has_default = !values.empty() && setting.kind != Setting::Kind::list;
  std::vector<std::string> notes;
  if (const std::string words = legal(setting); !words.empty()) notes.push_back(words);
  if (!has_default && !setting.unset.empty()) notes.push_back("default: " + setting.unset);
  std::string help = setting.help;
  if (!notes.empty()) help += fmt::format(" [{}]", fmt::join(notes, "; "));
  const std::string text = explained(help);
  if (has_default)
    return text + fmt::format("# {} = {}\n", setting.shown(), toml_value(setting, values.front()));
  const std::string value = toml_value(setting, setting.value.empty() ? "..." : setting.value);
  const bool list = setting.kind == Setting::Kind::list;
  return text + fmt::format("##   {} = {}\n", setting.shown(), list ? "[" + value + "]" : value);
}

}  // namespace

std::string recipe_reference() {
  std::string text = kHead;
  std::string_view group;
  for (const Setting& setting : bake_settings()) {
    if (setting.group != group) text += fmt::format("\n## {}\n", setting.group);
    group = setting.group;
    text += reference_of(setting);
  }
  return text;
}

}  // namespace ukemi
