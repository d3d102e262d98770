#include "base/files.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
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
  std::string content(const char* name) const {
    const auto bytes = read_file(folder / name, 1000);
    return bytes ? std::string(bytes->begin(), bytes->end()) : bytes.error().what;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder)) found.push_back(entry.path().filename());
    std::sort(found.begin(), found.end());
    return found;
  }
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

TEST_F(Files, WhatCannotTakeItsPlaceLeavesNothingBehind) {
  {
    PendingFiles files;
    ASSERT_TRUE(files.add(folder / "taken", std::string_view("x")));
    fs::create_directory(folder / "taken");  // meanwhile: a name in the way that cannot be replaced
    EXPECT_EQ(files.commit().error().kind, ErrorKind::output);
  }
  EXPECT_EQ(names(), std::vector<std::string>{"taken"});
}

TEST_F(Files, OfAPathThatGoesUpAreNotBelowTheFolder) {
  EXPECT_EQ(file_below(folder, "a/b.png"), folder / "a/b.png");
  EXPECT_EQ(file_below(folder, "../b.png"), std::nullopt);
  EXPECT_EQ(file_below(folder, "a/../b.png"), std::nullopt);
  EXPECT_EQ(file_below(folder / "not_there_yet", "../b.png"), std::nullopt);
}

TEST_F(Files, FailedWriteLeavesTheOldFile) {
  fs::create_directory(folder / "target");
  EXPECT_EQ(write_file(folder / "target", std::string_view("x")).error().kind, ErrorKind::output);
  EXPECT_EQ(write_file(folder / "no" / "such", std::string_view("x")).error().kind, ErrorKind::output);
  EXPECT_TRUE(fs::is_directory(folder / "target"));
}

TEST_F(Files, SeveralAppearTogetherOrNotAtAll) {
  ASSERT_TRUE(write_file(folder / "a", std::string_view("old")));
  fs::create_directory(folder / "b");
  {
    PendingFiles files;
    ASSERT_TRUE(files.add(folder / "a", std::string_view("new")));
    EXPECT_FALSE(files.add(folder / "b", std::string_view("new")));
  }
  EXPECT_EQ(content("a"), "old");
  EXPECT_EQ(names(), (std::vector<std::string>{"a", "b"}));
  PendingFiles files;
  ASSERT_TRUE(files.add(folder / "a", std::string_view("new")));
  ASSERT_TRUE(files.add(folder / "c", std::string_view("new")));
  EXPECT_EQ(content("a"), "old");
  ASSERT_TRUE(files.commit());
  EXPECT_EQ(content("a"), "new");
  EXPECT_EQ(content("c"), "new");
  EXPECT_EQ(names(), (std::vector<std::string>{"a", "b", "c"}));
}

TEST_F(Files, ALinkStaysALinkAndPermissionsStay) {
  ASSERT_TRUE(write_file(folder / "real", std::string_view("old")));
  fs::permissions(folder / "real", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("real", folder / "link");
  ASSERT_TRUE(write_file(folder / "link", std::string_view("new")));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(content("real"), "new");
  EXPECT_EQ(fs::status(folder / "real").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(Files, ADeviceOrPipeIsNeverReplaced) {
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(write_file(folder / "pipe", std::string_view("x")).error().what,
            "cannot write: is not a regular file");
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
}

TEST_F(Files, LongNamesAreWrittenAndTooLongOnesRefused) {
  EXPECT_TRUE(write_file(folder / std::string(255, 'a'), std::string_view("x")));
  EXPECT_EQ(write_file(folder / std::string(300, 'a'), std::string_view("x")).error().kind,
            ErrorKind::output);
}

TEST_F(Files, BelowAFolderIsOnlyWhatLinksDoNotLeadOut) {
  fs::create_directories(folder / "in" / "deep");
  ASSERT_TRUE(write_file(folder / "secret", std::string_view("x")));
  ASSERT_TRUE(write_file(folder / "in" / "deep" / "own", std::string_view("x")));
  fs::create_symlink(folder / "secret", folder / "in" / "leak");
  fs::create_symlink("..", folder / "in" / "up");
  fs::create_symlink("deep/own", folder / "in" / "fine");
  const fs::path in = folder / "in";
  EXPECT_TRUE(file_below(in, "deep/own"));
  EXPECT_TRUE(file_below(in, "./deep/own"));
  EXPECT_TRUE(file_below(in, "fine"));
  EXPECT_TRUE(file_below(in, "none"));
  for (const char* out : {"", "..", "../secret", "deep/../../secret", "/etc/passwd", "leak", "up/secret"})
    EXPECT_FALSE(file_below(in, out)) << out;
  EXPECT_FALSE(file_below(in, std::string("deep\0/own", 9)));
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
