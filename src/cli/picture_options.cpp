#include "cli/picture_options.h"

#include <fmt/format.h>

#include "base/errors.h"

namespace ukemi {

Status take_theme(const std::string& text, ThemeKind& theme) {
  if (text != "light" && text != "dark")
    return usage_error(fmt::format("unknown theme '{}'", text), "choose light or dark");
  theme = text == "dark" ? ThemeKind::dark : ThemeKind::light;
  return Done{};
}

}  // namespace ukemi
