// Every setting as data, for programs that make a form of them.
#pragma once

#include <string>

#include "base/result.h"

namespace ukemi {

/// JSON, format 1: { "format", "generator", "settings": [{"name", "group", "type": "number" | "text" |
/// "choice" | "switch" | "list", "default", "unset", "range": {"min", "max", "above_min"}, "choices", "unit",
/// "value", "help"}] }.
/// 1. The order is that of the help. What does not apply is null.
/// 2. "default" is a number, a text, true or false, or a list; null where the program finds the value out,
///    and then "unset" says from what.
/// 3. "choices" of a choice are all that is legal; those of a text are the words that stand for something.
/// 4. "value" is the placeholder of the help, "unit" the unit of a number ("1": none).
/// Errors: input (the presets cannot be read).
Result<std::string> settings_json();

}  // namespace ukemi
