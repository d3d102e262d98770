// What a batch says while it runs: a bar on a terminal, elsewhere a line for each reaction that has ended.
#pragma once

#include <chrono>
#include <set>
#include <string>
#include <utility>

#include "batch/batch.h"

namespace ukemi {

class BatchProgressView {
 public:
  /// `quiet`: says nothing.
  explicit BatchProgressView(bool quiet);
  ~BatchProgressView();
  BatchProgressView(const BatchProgressView&) = delete;
  BatchProgressView& operator=(const BatchProgressView&) = delete;

  void show(const BatchProgress& progress);
  /// Draws the bar again, for the clock.
  void tick();

 private:
  enum class Style { none, bar, lines };
  void say(const ReactionRecord& record, const BatchProgress& progress);

  Style style_;
  bool colours_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  BatchProgress shown_;
  std::set<std::pair<std::string, std::string>> told_;  // characters and their errors
  std::string drawn_;
};

/// "[#####-----] 123/1000  15.3/s  0:57 left  2 failed", at most `width` columns.
std::string progress_bar(const BatchProgress& progress, double elapsed_s, int width, bool colours);

}  // namespace ukemi
