#include "cli/stop_signals.h"

#include <csignal>
#include <initializer_list>

namespace ukemi {
namespace {

volatile std::sig_atomic_t g_stopped_by = 0;
void stop(int signal_number) { g_stopped_by = signal_number; }

}  // namespace

StopSignals::StopSignals() {
  struct sigaction action {};
  action.sa_handler = stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaction(number, &action, nullptr);
}

StopSignals::~StopSignals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_DFL);
}

int StopSignals::stopped_by() { return g_stopped_by; }

}  // namespace ukemi
