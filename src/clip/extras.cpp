#include "clip/extras.h"

#include <nlohmann/json.hpp>

namespace ukemi {

std::string with_fps(std::string_view extras_json, double fps) {
  auto json = nlohmann::ordered_json::parse(extras_json);
  json["ukemi"]["fps"] = fps;
  return json.dump();
}

}  // namespace ukemi
