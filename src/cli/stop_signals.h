// Ctrl-C as a wish: what is done so far is kept.
#pragma once

namespace ukemi {

/// While it lives, SIGINT, SIGTERM and SIGHUP are noted; a second one ends the program at once.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// The signal that came; 0: none.
  static int stopped_by();
};

}  // namespace ukemi
