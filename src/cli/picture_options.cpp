#include "cli/picture_options.h"

#include <fmt/format.h>

namespace ukemi {

Status take_theme(const std::string& text, ThemeKind& theme) {
  if (text != "light" && text != "dark")
    return Error{ErrorKind::usage,      "", 0, 0, "", fmt::format("unknown theme '{}'", text),
                 "choose light or dark"};
  theme = text == "dark" ? ThemeKind::dark : ThemeKind::light;
  return Done{};
}

}  // namespace ukemi
