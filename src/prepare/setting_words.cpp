#include "prepare/setting_words.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace ukemi {
namespace {

constexpr std::pair<std::string_view, std::string_view> kWords[] = {
    {"muscle", "muscle-strength"},   {"latency", "reaction-time"}, {"tone", "stiffness"},
    {"tone-fade", "stiffness-fade"}, {"lead", "pre-roll"},         {"recover", "return"},
    {"recover", "blend-out"},        {"to", "return-to"}};

constexpr std::string_view kEveryday[] = {"hit",       "from",  "preset", "strength", "clip", "at",
                                          "behaviour", "steps", "get-up", "seed",     "lead", "recover"};

}  // namespace

std::vector<std::string_view> other_words(std::string_view name) {
  std::vector<std::string_view> words;
  for (const auto& [setting, word] : kWords)
    if (setting == name) words.push_back(word);
  return words;
}

bool is_everyday(std::string_view name) {
  return std::find(std::begin(kEveryday), std::end(kEveryday), name) != std::end(kEveryday);
}

}  // namespace ukemi
