#include "cli/console.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "base/errors.h"

namespace ukemi {
namespace {

/// Control characters but line ends and tabs as '?': those of ASCII, and U+0080 to U+009F in UTF-8.
std::string printable(std::string text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    if ((byte < 0x20 && byte != '\n' && byte != '\t') || byte == 0x7F)
      text[i] = '?';
    else if (byte == 0xC2 && next >= 0x80 && next < 0xA0)
      text.replace(i, 2, "?");
  }
  return text;
}

}  // namespace

int print_error(const Error& error) {
  std::string text = "ukemi: error: " + error.message() + "\n";
  if (!error.fix.empty()) text += "  fix: " + error.fix + "\n";
  std::fputs(printable(std::move(text)).c_str(), stderr);
  return exit_status(error.kind);
}

void print_warnings(const Diagnostics& diagnostics) {
  for (const Warning& warning : diagnostics.warnings()) {
    const std::string subject = warning.subject.empty() ? "" : warning.subject + ": ";
    std::fputs(printable("ukemi: warning: " + subject + warning.what + "\n").c_str(), stderr);
  }
}

int print_result(const std::string& text, int status) { return print_json(printable(text), status); }

int print_json(const std::string& json, int status) {
  errno = 0;
  const bool written =
      std::fwrite(json.data(), 1, json.size(), stdout) == json.size() && std::fflush(stdout) == 0;
  if (written || errno == EPIPE || errno == EBADF) return status;  // nobody reads it
  return print_error(output_error({}, std::string("cannot write to stdout: ") + std::strerror(errno),
                                  "choose another place for the output"));
}

}  // namespace ukemi
