#include "batch/journal.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "base/digest.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

class Journals : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) /
             ("ukemi_journal_" + std::string(test->name()) + "_" + std::to_string(getpid()));
    fs::create_directories(folder / ".ukemi");
  }
  void TearDown() override { fs::remove_all(folder); }

  History history_of(const std::string& lines) const {
    std::ofstream(folder / ".ukemi" / "1-of-1.jsonl") << lines;
    return read_history(folder);
  }

  fs::path folder;
};

ReactionRecord record_of(const std::string& file) {
  ReactionRecord record;
  record.character = "mannequin";
  record.name = "head_left";
  record.digest = digest_of(std::string_view("inputs"));
  record.figures = ReactionFigures{};
  record.library = R"({"Name": "mannequin_head_left"})";
  record.files = {{file, 3, digest_of(std::string_view("old"))}};
  return record;
}

TEST_F(Journals, RecordsComeBack) {
  const History history = history_of(record_line(record_of("mannequin/head_left.glb")) + "\n");
  ASSERT_EQ(history.by_digest.size(), 1u);
  EXPECT_EQ(history.by_digest.begin()->second.files[0].name, "mannequin/head_left.glb");
}

TEST_F(Journals, NameNoFileOutsideTheirFolder) {
  for (const char* name : {"../outside.glb", "mannequin/../../outside.glb", "/tmp/outside.glb", "..", ""})
    EXPECT_TRUE(history_of(record_line(record_of(name)) + "\n").empty()) << name;
}

TEST_F(Journals, WithALibraryRowThatIsNoneAreNone) {
  for (const char* row : {"", "{", "7", "[]", "null", "{}", R"({"Name": 3})",
                          R"({"Name": "a", "Steps": null})", R"({"Name": "a", "Steps": [1]})"}) {
    ReactionRecord record = record_of("mannequin/head_left.glb");
    record.library = row;
    EXPECT_TRUE(history_of(record_line(record) + "\n").empty()) << row;
  }
}

TEST_F(Journals, LinesThatAreNoneArePassedOver) {
  const std::string whole = record_line(record_of("mannequin/head_left.glb"));
  const std::string verdict =
      R"({"character": "mannequin", "name": "head_left", "take": 2, "left_out": false, "comment": ""})";
  for (const char* line :
       {"", "{", "[]", "null", "7", R"({"take": 1})", R"({"take": 1, "character": 5, "name": []})",
        R"({"take": 1e99, "character": "a", "name": "b", "left_out": "no", "comment": null})", "\xff\xfe"}) {
    const History history = history_of(std::string(line) + "\n" + whole + "\n" + verdict + "\n" +
                                       whole.substr(0, whole.size() / 2));
    EXPECT_EQ(history.by_digest.size(), 1u) << line;
    EXPECT_EQ(history.verdicts.takes.size(), 1u) << line;
    EXPECT_EQ(history.verdicts.takes.begin()->second, 2) << line;
  }
}

}  // namespace
}  // namespace ukemi
