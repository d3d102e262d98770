#include "cli/console.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace ukemi {

int print_error(const Error& error) {
  std::string text = "ukemi: error: " + error.message() + "\n";
  if (!error.fix.empty()) text += "  fix: " + error.fix + "\n";
  std::fputs(text.c_str(), stderr);
  return exit_status(error.kind);
}

void print_warnings(const Diagnostics& diagnostics) {
  for (const Warning& warning : diagnostics.warnings()) {
    const std::string subject = warning.subject.empty() ? "" : warning.subject + ": ";
    std::fputs(("ukemi: warning: " + subject + warning.what + "\n").c_str(), stderr);
  }
}

int print_result(const std::string& text, int status) {
  errno = 0;
  const bool written =
      std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (written || errno == EPIPE || errno == EBADF) return status;  // nobody reads it
  return print_error({ErrorKind::output, "", 0, 0, "",
                      std::string("cannot write to stdout: ") + std::strerror(errno),
                      "choose another place for the output"});
}

}  // namespace ukemi
