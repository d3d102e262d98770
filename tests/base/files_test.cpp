#include "base/files.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace ukemi {
namespace fs = std::filesystem;
namespace {

class Files : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "ukemi_files_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder = pattern;
  }
  void TearDown() override { fs::remove_all(folder); }
  fs::path folder;
};

TEST_F(Files, WritesWholeAndReadsBack) {
  ASSERT_TRUE(write_file(folder / "a", std::string_view("hello")));
  const auto bytes = read_file(folder / "a", 100);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(std::string(bytes->begin(), bytes->end()), "hello");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1)
      << "temporary file left";
}

TEST_F(Files, RefusesWhatIsNoFile) {
  EXPECT_EQ(read_file(folder / "none", 10).error().kind, ErrorKind::input);
  EXPECT_EQ(read_file(folder, 10).error().what, "is a directory");
  ASSERT_TRUE(write_file(folder / "big", std::string_view("12345678901")));
  EXPECT_NE(read_file(folder / "big", 10).error().what.find("limit"), std::string::npos);
}

TEST_F(Files, FailedWriteLeavesTheOldFile) {
  fs::create_directory(folder / "target");
  EXPECT_EQ(write_file(folder / "target", std::string_view("x")).error().kind, ErrorKind::output);
  EXPECT_EQ(write_file(folder / "no" / "such", std::string_view("x")).error().kind, ErrorKind::output);
  EXPECT_TRUE(fs::is_directory(folder / "target"));
}

TEST_F(Files, ReplacesAFileWithoutLeavingAnything) {
  ASSERT_TRUE(write_file(folder / "a", std::string_view("old and long")));
  ASSERT_TRUE(write_file(folder / "a", std::string_view("new")));
  const auto bytes = read_file(folder / "a", 100);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(std::string(bytes->begin(), bytes->end()), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST_F(Files, AProcessThatIsKilledWhileItWritesLeavesNothing) {
  for (int i = 0; i < 20; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      const std::vector<std::uint8_t> large(256u << 20, 'x');
      static_cast<void>(write_file(folder / "a", large));
      _exit(0);
    }
    usleep(5000 * static_cast<unsigned>(i));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    for (const auto& entry : fs::directory_iterator(folder)) {
      EXPECT_EQ(entry.path().filename(), "a");
      EXPECT_EQ(entry.file_size(), 256u << 20);
    }
    fs::remove(folder / "a");
  }
}

TEST_F(Files, AFullDiskLeavesTheOldFileAndNothingElse) {
  ASSERT_TRUE(write_file(folder / "a", std::string_view("old")));
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &limit);
    const Status status = write_file(folder / "a", std::string(5000, 'x'));
    _exit(!status && status.error().kind == ErrorKind::output ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  const auto bytes = read_file(folder / "a", 100);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(std::string(bytes->begin(), bytes->end()), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace ukemi
