#include "base/parallel.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#include "base/errors.h"

namespace ukemi {
namespace {

constexpr const char* kFix = "this is a bug of the program; report it with what it was given";

/// What the threads of one call share.
class Shared {
 public:
  Shared(std::size_t count, const std::function<Status(std::size_t)>& work,
         const std::function<void(int)>& after_each)
      : count_(count), work_(work), after_each_(after_each) {}

  /// Until nothing is left or something has failed.
  void run() {
    while (!stopped_) {
      const std::size_t i = next_++;
      if (i >= count_) return;
      const Status status = without_exceptions([&] { return one(i); });
      if (!status) fail(i, status.error());
    }
  }
  Status answer() const {
    if (failure_) return *failure_;
    return Done{};
  }

 private:
  Status one(std::size_t i) {
    if (Status status = work_(i); !status) return status;
    const std::lock_guard lock(mutex_);
    ++done_;
    if (after_each_ && !failure_) after_each_(done_);
    return Done{};
  }
  void fail(std::size_t i, const Error& error) {
    stopped_ = true;
    const std::lock_guard lock(mutex_);
    if (failure_ && failed_ < i) return;
    failure_ = error;
    failed_ = i;
  }

  std::size_t count_;
  const std::function<Status(std::size_t)>& work_;
  const std::function<void(int)>& after_each_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  int done_ = 0;
  std::size_t failed_ = 0;
  std::optional<Error> failure_;
};

/// Fewer where the system gives no more.
std::vector<std::thread> started(int count, Shared& shared) {
  std::vector<std::thread> threads;
  try {
    for (int i = 0; i < count; ++i) threads.emplace_back([&shared] { shared.run(); });
  } catch (const std::system_error&) {
  }
  return threads;
}

}  // namespace

Status for_each_parallel(std::size_t count, int threads, const std::function<Status(std::size_t)>& work,
                         const std::function<void(int)>& after_each) {
  Shared shared(count, work, after_each);
  std::vector<std::thread> others = started(threads - 1, shared);
  shared.run();
  for (std::thread& other : others) other.join();
  return shared.answer();
}

Status without_exceptions(const std::function<Status()>& work) {
  try {
    return work();
  } catch (const std::exception& exception) {
    return internal_error(std::string("unexpected failure: ") + exception.what(), kFix);
  } catch (...) {
    return internal_error("unexpected failure", kFix);
  }
}

}  // namespace ukemi
