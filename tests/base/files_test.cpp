#include "base/files.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace ukemi
