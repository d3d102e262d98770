// How far something long has come.
#pragma once

#include <string>

namespace ukemi {

/// A line on stderr that is written over, and taken away at the end; nothing where stderr is no terminal.
class ProgressLine {
 public:
  /// `what` is counted: "run".
  ProgressLine(std::string what, bool wanted);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// "run 3 of 10".
  void show(int done, int total) const;

 private:
  std::string what_;
  bool shown_;
};

}  // namespace ukemi
