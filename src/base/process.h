// Pipes and processes of one's own: what a single confined child and a pool of workers share.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace ukemi {

/// A file descriptor that is closed at the end.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() { reset(); }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    reset();
    fd_ = std::exchange(other.fd_, -1);
    return *this;
  }
  int get() const { return fd_; }
  void reset();

 private:
  int fd_ = -1;
};

struct Pipe {
  Descriptor read, write;
};

/// A pipe that programs started by this one do not inherit; nothing where none can be made (see errno).
std::optional<Pipe> make_pipe();

/// Appends what can be read at once; false at the end of the stream. Bytes: std::string or a vector of them.
template <typename Bytes>
bool read_some(int fd, Bytes& bytes);

/// Waits until the child is gone; its status as waitpid gives it.
int wait_for_end(pid_t child);

/// In a child: killed when its parent ends. False where the parent is gone already.
bool die_with(pid_t parent);
/// In a child: no core files.
void leave_no_core();
/// In a child: limits its address space to this many bytes. Without effect under a sanitizer, whose shadow
/// takes terabytes.
void limit_addresses(std::size_t bytes);
/// In a child: files may not grow beyond this many bytes.
void limit_file_size(std::size_t bytes);

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

}  // namespace ukemi
