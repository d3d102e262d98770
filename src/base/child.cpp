#include "base/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
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

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // reserves terabytes of addresses, and reports to stderr
#else
constexpr bool kSanitized = false;
#endif

void limit(__rlimit_resource resource, rlim_t value) {
  const rlimit both{value, value};
  setrlimit(resource, &both);
}

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

void confine(const ChildLimits& limits) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit_processor_time(limits.processor_s);
  if (!kSanitized) limit(RLIMIT_AS, mapped_bytes() + limits.memory_bytes);
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTERM, SIGPIPE})
    signal(number, SIG_DFL);
  const int nowhere = kSanitized ? -1 : open("/dev/null", O_WRONLY);
  if (nowhere >= 0) dup2(nowhere, STDOUT_FILENO), dup2(nowhere, STDERR_FILENO);
}

[[noreturn]] void work_in_child(const std::function<std::vector<std::uint8_t>()>& work,
                                const ChildLimits& limits, int out) {
  int status = kFailed;
  try {
    confine(limits);
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
  constexpr std::size_t kBlock = 1 << 20;
  for (;;) {
    const double left_ms = std::chrono::duration<double, std::milli>(deadline - Clock::now()).count();
    if (left_ms <= 0.0) return Reading::too_long;
    pollfd waiting{in, POLLIN, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(std::ceil(std::min(left_ms, 1e6))));
    if (ready < 0 && errno != EINTR) return Reading::done;
    if (ready <= 0) continue;
    const std::size_t before = bytes.size();
    bytes.resize(before + kBlock);
    const ssize_t n = read(in, bytes.data() + before, kBlock);
    bytes.resize(before + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return Reading::done;
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
      return input_error(path, "makes its reader be killed, probably because memory ran out", kSimplify);
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
  return {ErrorKind::internal,
          "",
          0,
          0,
          "",
          fmt::format("cannot make a process: {}", what),
          "close other programs and try again"};
}

}  // namespace

Result<std::vector<std::uint8_t>> run_in_child(const std::function<std::vector<std::uint8_t>()>& work,
                                               const ChildLimits& limits, const std::filesystem::path& path) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return no_process(std::strerror(errno));
  const pid_t child = fork();
  if (child < 0) {
    const Error error = no_process(std::strerror(errno));
    close(ends[0]), close(ends[1]);
    return error;
  }
  if (child == 0) work_in_child(work, limits, ends[1]);
  close(ends[1]);
  std::vector<std::uint8_t> bytes;
  const Reading reading = read_all(ends[0], limits, bytes);
  close(ends[0]);
  if (reading != Reading::done) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (reading == Reading::too_long) return too_long(path, "waiting", limits.wall_s);
  if (reading == Reading::too_much)
    return input_error(path, fmt::format("makes more than {} MiB of data", limits.result_bytes >> 20),
                       kSimplify);
  if (auto error = failure(status, limits, path)) return *error;
  return bytes;
}

}  // namespace ukemi
