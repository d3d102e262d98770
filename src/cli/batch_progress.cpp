#include "cli/batch_progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace ukemi {
namespace {

constexpr int kLongestBar = 30;

std::string clock_text(double seconds) {
  const long whole = static_cast<long>(seconds + 0.5);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

}  // namespace

std::string progress_bar(const BatchProgress& progress, double elapsed_s, int width, bool colours) {
  const double done = static_cast<double>(progress.finished), total = static_cast<double>(progress.total);
  const double rate = elapsed_s > 0.0 ? done / elapsed_s : 0.0;
  std::string text = fmt::format(" {}/{}", progress.finished, progress.total);
  if (progress.finished > 0 && rate > 0.0)
    text += fmt::format("  {:.1f}/s  {} left", rate, clock_text((total - done) / rate));
  const std::string failed = progress.failed > 0 ? fmt::format("  {} failed", progress.failed) : "";
  const int room = width - 3 - static_cast<int>(text.size() + failed.size());
  const int length = std::clamp(room, 0, kLongestBar);
  const int filled = total > 0.0 ? static_cast<int>(done / total * length) : length;
  std::string bar;
  if (length > 3) bar = fmt::format("[{:#<{}}{:-<{}}]", "", filled, "", length - filled);
  return bar + text + (colours && !failed.empty() ? "\033[31m" + failed + "\033[0m" : failed);
}

BatchProgressView::BatchProgressView(bool quiet)
    : style_(quiet                        ? Style::none
             : isatty(STDERR_FILENO) != 0 ? Style::bar
                                          : Style::lines),
      colours_(!is_set("NO_COLOR")) {}

BatchProgressView::~BatchProgressView() {
  if (style_ == Style::bar) std::fputs("\r\033[K", stderr);
}

void BatchProgressView::show(const BatchProgress& progress) {
  shown_ = progress;
  if (style_ != Style::none && progress.last != nullptr) say(*progress.last, progress);
  shown_.last = nullptr;
  tick();
}

/// A failure is printed on a terminal too.
void BatchProgressView::say(const ReactionRecord& record, const BatchProgress& progress) {
  if (style_ == Style::bar && record.done()) return;
  std::string line =
      fmt::format("{}/{} {}/{}", progress.finished, progress.total, record.character, record.name);
  if (record.done())
    line += fmt::format(
        ": {:.2f} s, excess {:.2f} degrees, {}", record.figures->duration_s, record.figures->excess_max_deg,
        record.figures->rest_time_s ? fmt::format("at rest after {:.2f} s", *record.figures->rest_time_s)
                                    : std::string("not at rest"));
  else
    line += told_.emplace(record.character, record.error).second
                ? ": failed: " + record.error
                : std::string(": failed for the same reason");
  if (style_ == Style::bar) line = "\r\033[K" + line;
  std::fputs((line + "\n").c_str(), stderr);
  drawn_.clear();
}

void BatchProgressView::tick() {
  if (style_ != Style::bar || shown_.total == 0) return;
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const std::string bar = progress_bar(shown_, elapsed_s, terminal_width() - 1, colours_);
  if (bar == drawn_) return;
  std::fputs(("\r\033[K" + bar).c_str(), stderr);
  std::fflush(stderr);
  drawn_ = bar;
}

}  // namespace ukemi
