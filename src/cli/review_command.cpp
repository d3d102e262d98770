#include "review/review.h"

#include <fmt/format.h>

#include <string>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/progress_line.h"

namespace ukemi {
namespace {

constexpr const char* kAboutThePage =
    "\nDIR/index.html opens from disk in any browser, and from any web server; it needs DIR/review/ beside "
    "it\n"
    "and the clips only for its links. Verdicts stay in the browser; Export writes them to a JSON file for\n"
    "ukemi batch RECIPE --rejects FILE.\n";

std::string counted(int count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

int review_command(const Arguments& arguments) {
  std::string folder;
  ReviewSettings settings;
  bool quiet = false;
  Options options("review", "makes the web page to judge reactions by");
  options.argument("DIR", folder, "what ukemi batch wrote, or any folder of baked clips and their reports");
  options.whole("-j,--jobs", "N", settings.threads, 1, 256, "clips read at the same time");
  options.flag("--quiet", quiet, "nothing on stdout");
  if (const auto status = status_at_once(options, arguments, kAboutThePage)) return *status;

  Diagnostics diagnostics;
  const auto review = [&] {
    const ProgressLine line("clip", !quiet);
    return write_review(folder, settings, diagnostics,
                        [&line](int done, int total) { line.show(done, total); });
  }();
  print_warnings(diagnostics);
  if (!review) return print_error(review.error());
  if (quiet) return 0;
  return print_result(fmt::format("{}, {}, {}\nwrote {}\n", counted(review->reactions, "reaction"),
                                  counted(review->clips, "clip"), counted(review->characters, "character"),
                                  review->page.string()),
                      0);
}

}  // namespace ukemi
