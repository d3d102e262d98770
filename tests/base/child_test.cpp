#include "base/child.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace ukemi {
namespace {

using Bytes = std::vector<std::uint8_t>;

Error failure_of(const std::function<Bytes()>& work, const ChildLimits& limits = {}) {
  const auto result = run_in_child(work, limits, "hero.fbx");
  EXPECT_FALSE(result);
  if (result) return {};
  EXPECT_EQ(result.error().kind, ErrorKind::input);
  EXPECT_EQ(result.error().file, "hero.fbx");
  EXPECT_FALSE(result.error().fix.empty());
  return result.error();
}

TEST(Child, ReturnsWhatItsWorkReturns) {
  Bytes large(5'000'000);
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<std::uint8_t>(i * 7);
  EXPECT_EQ(*run_in_child([&] { return large; }, {}, "hero.fbx"), large);
  EXPECT_TRUE(run_in_child([] { return Bytes{}; }, {}, "hero.fbx")->empty());
}

TEST(Child, LeavesTheMemoryOfItsParentAlone) {
  int value = 1;
  const auto result = run_in_child(
      [&] {
        value = 2;
        return Bytes{9};
      },
      {}, "hero.fbx");
  ASSERT_TRUE(result);
  EXPECT_EQ(value, 1);
}

TEST(Child, ThatCrashesIsAnError) {
  EXPECT_NE(failure_of([]() -> Bytes {
              std::raise(SIGSEGV);
              return {};
            }).what.find("crash (signal 11"),
            std::string::npos);
  EXPECT_NE(failure_of([]() -> Bytes { std::abort(); }).what.find("crash"), std::string::npos);
  EXPECT_NE(failure_of([]() -> Bytes { throw std::runtime_error("no"); }).what.find("status"),
            std::string::npos);
  EXPECT_NE(failure_of([]() -> Bytes {
              std::raise(SIGKILL);
              return {};
            }).what.find("memory ran out"),
            std::string::npos);
  EXPECT_NE(failure_of([]() -> Bytes { _exit(7); }).what.find("status 7"), std::string::npos);
}

TEST(Child, ThatHangsIsGivenUp) {
  ChildLimits limits;
  limits.wall_s = 0.2;
  const auto start = std::chrono::steady_clock::now();
  const Error waiting = failure_of(
      []() -> Bytes {
        for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
      },
      limits);
  EXPECT_EQ(waiting.what, "takes more than 0.2 s of waiting time to read; it was given up");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST(Child, ThatComputesForEverIsGivenUp) {
  ChildLimits limits;
  limits.processor_s = 1.0;
  const Error busy = failure_of(
      []() -> Bytes {
        for (std::atomic<int> i = 0;; ++i) {
        }
      },
      limits);
  EXPECT_NE(busy.what.find("1 s of processor time"), std::string::npos) << busy.what;
}

TEST(Child, ThatWantsTooMuchMemoryIsAnError) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer needs all addresses";
#endif
  ChildLimits limits;
  limits.memory_bytes = 64 << 20;
  const auto grows = [] { return Bytes(200 << 20, 1); };
  EXPECT_EQ(failure_of(grows, limits).what, "needs more than 64 MiB of memory to read");
  limits.memory_bytes = 1024 << 20;
  EXPECT_TRUE(run_in_child(grows, limits, "hero.fbx")) << "the limit is the child's own, and high enough";
  rlimit own{};
  getrlimit(RLIMIT_AS, &own);
  EXPECT_EQ(own.rlim_cur, RLIM_INFINITY) << "the parent stays free";
}

TEST(Child, ThatSendsTooMuchIsAnError) {
  ChildLimits limits;
  limits.result_bytes = 1 << 20;
  EXPECT_EQ(failure_of([] { return Bytes(4 << 20); }, limits).what, "makes more than 1 MiB of data");
}

TEST(Child, WritesNoFiles) {
  const std::string path = ::testing::TempDir() + "/written_by_child";
  std::remove(path.c_str());
  (void)run_in_child(
      [&] {
        std::signal(SIGXFSZ, SIG_IGN);
        std::ofstream(path) << "x" << std::flush;
        return Bytes{};
      },
      {}, "hero.fbx");
  std::ifstream file(path, std::ios::ate);
  EXPECT_LE(static_cast<int>(file.tellg()), 0);
  std::remove(path.c_str());
}

}  // namespace
}  // namespace ukemi
