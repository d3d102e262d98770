#include "base/process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <vector>

namespace ukemi {
namespace {

void limit(__rlimit_resource resource, std::size_t value) {
  const rlimit both{value, value};
  setrlimit(resource, &both);
}

}  // namespace

void Descriptor::reset() {
  if (fd_ >= 0) close(fd_);
  fd_ = -1;
}

std::optional<Pipe> make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
  return Pipe{Descriptor(ends[0]), Descriptor(ends[1])};
}

template <typename Bytes>
bool read_some(int fd, Bytes& bytes) {
  constexpr std::size_t kBlock = 65536;  // what a pipe holds
  const std::size_t before = bytes.size();
  bytes.resize(before + kBlock);
  const ssize_t n = ::read(fd, bytes.data() + before, kBlock);
  bytes.resize(before + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
  if (n < 0) return errno == EINTR || errno == EAGAIN;
  return n > 0;
}
template bool read_some(int fd, std::string& bytes);
template bool read_some(int fd, std::vector<std::uint8_t>& bytes);

int wait_for_end(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

bool die_with(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  return getppid() == parent;
}

void leave_no_core() { limit(RLIMIT_CORE, 0); }

void limit_addresses(std::size_t bytes) {
  if (!kSanitized) limit(RLIMIT_AS, bytes);
}

void limit_file_size(std::size_t bytes) { limit(RLIMIT_FSIZE, bytes); }

}  // namespace ukemi
