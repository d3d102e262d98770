#include "base/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>

#include "base/descriptors.h"
#include "base/errors.h"
#include "base/process.h"

namespace ukemi {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kDamaged =
    "the file is damaged or holds something that the reader does not know: export it again, or as .glb";
constexpr const char* kSimplify = "use a simpler file, or export it as .glb";

// Exit statuses of the child.
constexpr int kDone = 0;
constexpr int kOutOfMemory = 1;
constexpr int kFailed = 2;

/// SIGXCPU, which tells what happened, comes at the soft limit, SIGKILL at the hard one.
void limit_processor_time(double seconds) {
  const auto soft = static_cast<rlim_t>(std::ceil(seconds));
  const rlimit both{soft, soft + 1};
  setrlimit(RLIMIT_CPU, &both);
}

rlim_t mapped_bytes() {
  std::ifstream statm("/proc/self/statm");
  unsigned long long pages = 0;
  statm >> pages;
  return static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

void confine(const ChildLimits& limits, pid_t parent) {
  if (!die_with(parent)) _exit(kFailed);
  leave_no_core();
  limit_file_size(0);
  limit_processor_time(limits.processor_s);
  limit_addresses(mapped_bytes() + limits.memory_bytes);
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTERM, SIGPIPE})
    signal(number, SIG_DFL);
  const int nowhere = kSanitized ? -1 : open("/dev/null", O_WRONLY);
  if (nowhere >= 0) dup2(nowhere, STDOUT_FILENO), dup2(nowhere, STDERR_FILENO);
}

[[noreturn]] void work_in_child(const std::function<std::vector<std::uint8_t>()>& work,
                                const ChildLimits& limits, pid_t parent, int out) {
  int status = kFailed;
  try {
    confine(limits, parent);
    status = write_all(out, work()) ? kDone : kFailed;
  } catch (const std::bad_alloc&) {
    status = kOutOfMemory;
  } catch (...) {
  }
  _exit(status);
}

enum class Reading { done, too_long, too_much };

/// Everything that comes through the pipe until it is closed.
Reading read_all(int in, const ChildLimits& limits, std::vector<std::uint8_t>& bytes) {
  const auto deadline = Clock::now() + std::chrono::duration<double>(limits.wall_s);
  for (;;) {
    const double left_ms = std::chrono::duration<double, std::milli>(deadline - Clock::now()).count();
    if (left_ms <= 0.0) return Reading::too_long;
    pollfd waiting{in, POLLIN, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(std::ceil(std::min(left_ms, 1e6))));
    if (ready < 0 && errno != EINTR) return Reading::done;
    if (ready <= 0) continue;
    if (!read_some(in, bytes)) return Reading::done;
    if (bytes.size() > limits.result_bytes) return Reading::too_much;
  }
}

Error too_long(const std::filesystem::path& path, const char* clock, double seconds) {
  return input_error(path,
                     fmt::format("takes more than {} s of {} time to read; it was given up", seconds, clock),
                     kSimplify);
}

/// What went wrong in a child that ended with `status`, as waitpid gives it; nothing where all went well.
std::optional<Error> failure(int status, const ChildLimits& limits, const std::filesystem::path& path) {
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    if (number == SIGKILL)
      return input_error(path, "its reader was killed, probably because memory ran out", kSimplify);
    if (number == SIGXCPU) return too_long(path, "processor", limits.processor_s);
    return input_error(path, fmt::format("makes its reader crash (signal {}, {})", number, strsignal(number)),
                       kDamaged);
  }
  if (WEXITSTATUS(status) == kDone) return std::nullopt;
  if (WEXITSTATUS(status) == kOutOfMemory)
    return input_error(
        path, fmt::format("needs more than {} MiB of memory to read", limits.memory_bytes >> 20), kSimplify);
  return input_error(path, fmt::format("makes its reader end with status {}", WEXITSTATUS(status)), kDamaged);
}

Error no_process(const char* what) {
  return internal_error(fmt::format("cannot make a process: {}", what), "close other programs and try again");
}

}  // namespace

Result<std::vector<std::uint8_t>> run_in_child(const std::function<std::vector<std::uint8_t>()>& work,
                                               const ChildLimits& limits, const std::filesystem::path& path) {
  auto pipe = make_pipe();
  if (!pipe) return no_process(std::strerror(errno));
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) return no_process(std::strerror(errno));
  if (child == 0) work_in_child(work, limits, parent, pipe->write.get());
  pipe->write.reset();
  std::vector<std::uint8_t> bytes;
  const Reading reading = read_all(pipe->read.get(), limits, bytes);
  pipe->read.reset();
  if (reading != Reading::done) kill(child, SIGKILL);
  const int status = wait_for_end(child);
  if (reading == Reading::too_long) return too_long(path, "waiting", limits.wall_s);
  if (reading == Reading::too_much)
    return input_error(path, fmt::format("makes more than {} MiB of data", limits.result_bytes >> 20),
                       kSimplify);
  if (auto error = failure(status, limits, path)) return *error;
  return bytes;
}

}  // namespace ukemi
