#include "base/process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/descriptors.h"

namespace ukemi {
namespace {

TEST(Process, APipeCarriesBytesUntilItsEndIsClosed) {
  auto pipe = make_pipe();
  ASSERT_TRUE(pipe);
  ASSERT_TRUE(write_all(pipe->write.get(), std::string_view("ab")));
  std::string text = "x";
  EXPECT_TRUE(read_some(pipe->read.get(), text));
  EXPECT_EQ(text, "xab");
  pipe->write.reset();
  EXPECT_FALSE(read_some(pipe->read.get(), text));
  EXPECT_EQ(text, "xab");
}

TEST(Process, AChildWithoutItsParentSaysSo) {
  const pid_t child = fork();
  if (child == 0) _exit(die_with(getppid()) && !die_with(-7) ? 5 : 6);
  const int status = wait_for_end(child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 5);
}

TEST(Process, AChildDiesWithItsParent) {
  auto pipe = make_pipe();
  ASSERT_TRUE(pipe);
  const pid_t parent = fork();
  if (parent == 0) {
    const pid_t self = getpid();
    if (fork() == 0) {
      if (!die_with(self)) _exit(1);
      static_cast<void>(write_all(pipe->write.get(), std::string_view("!")));
      for (;;) pause();
    }
    for (;;) pause();
  }
  pipe->write.reset();
  std::string text;
  EXPECT_TRUE(read_some(pipe->read.get(), text));  // the grandchild is ready
  kill(parent, SIGKILL);
  wait_for_end(parent);
  EXPECT_FALSE(read_some(pipe->read.get(), text)) << "its end of the pipe is closed";
}

}  // namespace
}  // namespace ukemi
