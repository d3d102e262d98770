#include "bake/events.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/version.h"

namespace ukemi {

std::string events_json(const Clip& clip) {
  using Json = nlohmann::ordered_json;
  std::vector<Mark> marks = clip.marks;
  std::stable_sort(marks.begin(), marks.end(),
                   [](const Mark& a, const Mark& b) { return a.time_s < b.time_s; });
  Json json;
  json["format"] = 1;
  json["generator"] = generator();
  json["clip"] = clip.name;
  json["duration_s"] = clip.duration_s();
  json["fps"] = clip.fps;
  json["events"] = Json::array();
  for (const Mark& mark : marks)
    json["events"].push_back(
        {{"name", mark.name}, {"time_s", mark.time_s}, {"frame", std::lround(mark.time_s * clip.fps)}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace ukemi
