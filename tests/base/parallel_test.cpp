#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/errors.h"

namespace ukemi {
namespace {

TEST(Parallel, DoesEachThingOnceAndCountsUp) {
  for (const int threads : {1, 2, 5}) {
    std::vector<int> times(100, 0), counted;
    const auto work = [&](std::size_t i) -> Status {
      ++times[i];
      return Done{};
    };
    ASSERT_TRUE(for_each_parallel(times.size(), threads, work, [&](int done) { counted.push_back(done); }));
    EXPECT_EQ(times, std::vector<int>(100, 1));
    ASSERT_EQ(counted.size(), 100u);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(counted[static_cast<std::size_t>(i)], i + 1);
  }
}

TEST(Parallel, NothingToDoIsDone) {
  EXPECT_TRUE(for_each_parallel(0, 3, [](std::size_t) -> Status { throw std::logic_error("called"); }));
}

TEST(Parallel, AnExceptionOfTheWorkIsAnErrorOnEveryThread) {
  for (const int threads : {1, 4}) {
    const Status status =
        for_each_parallel(8, threads, [](std::size_t) -> Status { throw std::runtime_error("out of eggs"); });
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().kind, ErrorKind::internal);
    EXPECT_EQ(status.error().what, "unexpected failure: out of eggs");
  }
}

TEST(Parallel, AnExceptionThatIsNoneOfTheLibrarysIsAnErrorToo) {
  EXPECT_FALSE(for_each_parallel(2, 2, [](std::size_t) -> Status { throw 7; }));
}

TEST(Parallel, AnExceptionOfTheCounterIsAnError) {
  const Status status = for_each_parallel(
      8, 2, [](std::size_t) -> Status { return Done{}; },
      [](int) { throw std::runtime_error("no terminal"); });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().what, "unexpected failure: no terminal");
}

/// The second error comes first in time.
TEST(Parallel, TheErrorOfTheLowestIndexIsTheAnswer) {
  std::atomic<bool> second_failed = false;
  const Status status = for_each_parallel(2, 2, [&](std::size_t i) -> Status {
    if (i == 1) {
      second_failed = true;
      return internal_error("second", "");
    }
    for (int ms = 0; ms < 2000 && !second_failed; ++ms)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return internal_error("first", "");
  });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().what, "first");
}

TEST(Parallel, NothingIsBegunAfterAnError) {
  int begun = 0;
  EXPECT_FALSE(for_each_parallel(10, 1, [&](std::size_t i) -> Status {
    ++begun;
    if (i == 2) return internal_error("third", "");
    return Done{};
  }));
  EXPECT_EQ(begun, 3);
}

}  // namespace
}  // namespace ukemi
