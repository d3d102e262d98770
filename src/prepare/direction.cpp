#include "prepare/direction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/math.h"
#include "base/nearest.h"
#include "base/numbers.h"

namespace ukemi {
namespace {

const std::vector<std::string> kDirectionNames = {
    "front", "back", "left", "right", "above", "front_left", "back_left", "back_right", "front_right"};

/// Words as a library's tables have them: "front-left" -> "front_left".
std::string with_underscores(std::string_view text) {
  std::string word(text);
  std::replace(word.begin(), word.end(), '-', '_');
  return word;
}

}  // namespace

Result<Direction> parse_direction(std::string_view text) {
  constexpr double quarter = 0.5 * kPi;
  constexpr double eighth = 0.25 * kPi;
  const std::pair<double, double> words[] = {{0, 0},          {kPi, 0},         {quarter, 0},
                                             {-quarter, 0},   {0, quarter},     {eighth, 0},
                                             {3 * eighth, 0}, {-3 * eighth, 0}, {-eighth, 0}};
  const std::string word = with_underscores(text);
  for (std::size_t i = 0; i < kDirectionNames.size(); ++i)
    if (word == kDirectionNames[i]) return Direction{words[i].first, words[i].second, word};
  const auto comma = text.find(',');
  const auto azimuth = number_in(text.substr(0, comma));
  const auto elevation = comma == text.npos ? std::optional(0.0) : number_in(text.substr(comma + 1));
  const std::string what = fmt::format("'{}' is not a direction", text);
  if (!azimuth || !elevation) {
    const std::string near = nearest_word(text, kDirectionNames);
    return usage_error(
        what, near.empty()
                  ? "give front, back, left, right, above, front_left and so on, or AZIMUTH[,ELEVATION] "
                    "in degrees"
                  : fmt::format("did you mean '{}'?", near));
  }
  if (std::abs(*azimuth) > 360.0 || std::abs(*elevation) > 90.0)
    return usage_error(what + ": out of range",
                       "give an azimuth from -360 to 360 and an elevation from -90 to 90 degrees");
  return Direction{radians(*azimuth), radians(*elevation), std::string(text)};
}

}  // namespace ukemi
