#include "base/result.h"

#include <algorithm>

namespace ukemi {

std::string Error::message() const {
  std::string text;
  if (!file.empty()) {
    text += file;
    if (line > 0) text += ':' + std::to_string(line);
    if (line > 0 && column > 0) text += ':' + std::to_string(column);
    text += ": ";
  }
  if (!joint.empty()) text += "joint '" + joint + "': ";
  return text + what;
}

int exit_status(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
    case ErrorKind::input:
      return 2;
    case ErrorKind::simulation:
      return 3;
    case ErrorKind::output:
      return 4;
    case ErrorKind::internal:
      break;
  }
  return 70;
}

void Diagnostics::warn(std::string subject, std::string what) {
  const bool known = std::any_of(warnings_.begin(), warnings_.end(),
                                 [&](const Warning& w) { return w.subject == subject && w.what == what; });
  if (!known) warnings_.push_back({std::move(subject), std::move(what)});
}

}  // namespace ukemi
