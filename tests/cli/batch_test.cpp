// Whole batches with the real program: the same bytes however they are made, and nothing lost whatever
// happens.
#include <signal.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "program.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;

/// Short reactions: eight of them.
constexpr const char* kRecipe = R"(format = 1
characters = ["mannequin"]
outputs = ["glb", "bvh", "report"]
[settings]
duration = 0.2
clip-only = true
[[matrix]]
hit = ["head", "chest"]
from = ["left", 45]
variations = 2
jitter = { direction-deg = 10, strength-percent = 10, point-m = 0.02 }
)";

constexpr int kReactions = 8;

/// The same with many more, so that there is time to interrupt.
std::string long_recipe() {
  std::string text = kRecipe;
  return text.replace(text.find("variations = 2"), 14, "variations = 50");
}

class Batch : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write("r.toml", kRecipe);
  }

  Ran batch(const std::string& out, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"batch", "r.toml", "-o", out, "--no-review"});
    return run(more);
  }

  /// Every file below a folder by its path; reports without their timings, journals left out.
  std::map<std::string, std::string> content(const std::string& name) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder / name)) {
      const std::string path = fs::relative(entry.path(), folder / name).string();
      if (!entry.is_regular_file() || path.starts_with(".ukemi") || path.starts_with("review")) continue;
      std::string bytes = read(name + "/" + path);
      if (entry.path().extension() == ".json" && path.find('/') != path.npos) {
        Json report = Json::parse(bytes);
        report.erase("timings_s");
        bytes = report.dump();
      }
      files[path] = bytes;
    }
    return files;
  }

  void expect_same(const std::string& a, const std::string& b) const {
    const auto left = content(a), right = content(b);
    ASSERT_GT(left.size(), 8u);
    std::vector<std::string> differ;
    for (const auto& [path, bytes] : left)
      if (!right.contains(path) || right.at(path) != bytes) differ.push_back(path);
    for (const auto& [path, bytes] : right)
      if (!left.contains(path)) differ.push_back(path);
    EXPECT_EQ(differ, std::vector<std::string>());
  }

  Json manifest(const std::string& out) const { return Json::parse(read(out + "/manifest.json")); }

  std::size_t lines_of_journal(const std::string& out) const {
    const std::string text = read(out + "/.ukemi/1-of-1.jsonl");
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }

  /// Waits until so many reactions are finished; false where they never are.
  bool wait_for(const std::string& out, std::size_t finished) const {
    for (int i = 0; i < 3000; ++i) {
      if (lines_of_journal(out) >= finished) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  /// Times of last change, to see what was baked again.
  std::map<std::string, fs::file_time_type> times(const std::string& out) const {
    std::map<std::string, fs::file_time_type> result;
    for (const auto& entry : fs::recursive_directory_iterator(folder / out / "mannequin"))
      result[entry.path().filename().string()] = entry.last_write_time();
    return result;
  }

  std::set<std::string> changed(const std::string& out,
                                const std::map<std::string, fs::file_time_type>& before) const {
    std::set<std::string> names;
    for (const auto& [name, time] : times(out))
      if (!before.contains(name) || before.at(name) != time) names.insert(name.substr(0, name.rfind('.')));
    return names;
  }
};

TEST_F(Batch, BytesAreTheSameForEveryNumberOfWorkersAndEveryShardSplit) {
  EXPECT_EQ(batch("one", {"-j", "1"}).status, 0);
  EXPECT_EQ(batch("two", {"-j", "2"}).status, 0);
  expect_same("one", "two");
  for (const char* shard : {"1/3", "2/3", "3/3"}) EXPECT_EQ(batch("split", {"--shard", shard}).status, 0);
  EXPECT_FALSE(fs::exists(folder / "split/manifest.json"));
  EXPECT_EQ(batch("split", {"--merge", "split"}).status, 0);
  for (const char* part : {"1-of-3", "2-of-3", "3-of-3"})
    for (const char* kind : {".json", ".csv"})
      for (const char* table : {"manifest.", "library."})
        EXPECT_TRUE(fs::remove(folder / "split" / (std::string(table) + part + kind)));
  expect_same("one", "split");
  EXPECT_EQ(batch("apart1", {"--shard", "1/2"}).status, 0);
  EXPECT_EQ(batch("apart2", {"--shard", "2/2"}).status, 0);
  EXPECT_EQ(batch("whole", {"--merge", "apart1", "--merge", "apart2"}).status, 0);
  expect_same("one", "whole");
}

TEST_F(Batch, AMergeTellsWhatIsMissing) {
  EXPECT_EQ(batch("part", {"--shard", "1/2"}).status, 0);
  const Ran merged = batch("whole", {"--merge", "part"});
  EXPECT_EQ(merged.status, 1);
  EXPECT_NE(merged.out.find("4 done, 0 rejected, 4 failed"), std::string::npos) << merged.out;
  EXPECT_NE(merged.out.find("is in none of the merged folders"), std::string::npos);
  EXPECT_EQ(batch("whole", {"--resume"}).status, 0);
  EXPECT_EQ(batch("direct").status, 0);
  expect_same("direct", "whole");
}

TEST_F(Batch, IsGoneOnWithAfterKill9AtAnyMoment) {
  write("r.toml", long_recipe());
  for (int i = 1; i <= 4; ++i) {
    const pid_t child = start({"batch", "r.toml", "-o", "out", "-j", "2", "--resume", "--no-review"});
    EXPECT_TRUE(wait_for("out", static_cast<std::size_t>(12 * i)));
    usleep(static_cast<unsigned>(7000 * i));
    kill(child, SIGKILL);
    EXPECT_EQ(wait(child).status, -1);
  }
  for (const auto& entry : fs::recursive_directory_iterator(folder / "out" / "mannequin")) {
    const std::string kind = entry.path().extension();
    EXPECT_TRUE(kind == ".glb" || kind == ".bvh" || kind == ".json") << entry.path();
  }
  const auto before = times("out");
  const std::size_t finished = lines_of_journal("out");
  EXPECT_EQ(batch("out", {"--resume"}).status, 0);
  EXPECT_LE(changed("out", before).size(), 200u - finished + 1u) << "what was finished is baked again";
  EXPECT_EQ(batch("direct").status, 0);
  expect_same("direct", "out");
}

TEST_F(Batch, StopsWithinASecondOfCtrlCAndSaysHowToGoOn) {
  write("r.toml", long_recipe());
  for (const int number : {SIGINT, SIGTERM}) {
    fs::remove_all(folder / "out");
    const pid_t child = start({"batch", "r.toml", "-o", "out", "-j", "2"});
    EXPECT_TRUE(wait_for("out", 5));
    const auto start = std::chrono::steady_clock::now();
    kill(child, number);
    const Ran stopped = wait(child);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 1.5);
    EXPECT_EQ(stopped.status, 128 + number);
    EXPECT_NE(stopped.err.find("to go on: ukemi batch r.toml -o out --resume"), std::string::npos);
    const Json partial = manifest("out");
    EXPECT_EQ(partial["complete"], false);
    EXPECT_EQ(partial["planned"], 200);
    EXPECT_GE(partial["reactions"].size(), 5u);
    EXPECT_EQ(partial["reactions"].size(), lines_of_journal("out"));
  }
}

TEST_F(Batch, ResumeBakesWhatIsMissingOrChangedAndNothingElse) {
  EXPECT_EQ(batch("out").status, 0);
  auto before = times("out");
  const Ran nothing = batch("out", {"--resume"});
  EXPECT_EQ(nothing.status, 0);
  EXPECT_NE(nothing.out.find("8 done (8 from before)"), std::string::npos) << nothing.out;
  EXPECT_TRUE(changed("out", before).empty());

  fs::remove(folder / "out/mannequin/head_left_1.bvh");
  write("out/mannequin/chest_45_0.glb", "damaged");
  EXPECT_EQ(batch("out", {"--resume"}).status, 0);
  EXPECT_EQ(changed("out", before), (std::set<std::string>{"head_left_1", "chest_45_0"}));

  write("r.toml", std::string(kRecipe) + "[[reaction]]\nname = \"more\"\n");
  before = times("out");
  EXPECT_EQ(batch("out", {"--resume"}).status, 0);
  EXPECT_EQ(changed("out", before), (std::set<std::string>{"more"}));
}

TEST_F(Batch, AChangedCharacterOrRegionIsBakedAgain) {
  fs::copy_file(fs::path(UKEMI_ASSETS_FOLDER) / "characters/mannequin.bvh", folder / "man.bvh");
  write("region.toml", "format = 1\nbase = \"human\"\n[[joint]]\nname = \"elbow_l\"\nalpha = [-10, 10]\n");
  write("r.toml",
        "format = 1\ncharacters = [\"man.bvh\"]\noutputs = [\"bvh\"]\n[settings]\nduration = 0.1\n"
        "region = \"region.toml\"\n[[reaction]]\nname = \"one\"\n");
  EXPECT_EQ(batch("out").status, 0);
  const std::string first = manifest("out")["reactions"][0]["digest"];
  write("region.toml", "format = 1\nbase = \"human\"\n[[joint]]\nname = \"elbow_l\"\nalpha = [-11, 10]\n");
  EXPECT_EQ(batch("out", {"--resume"}).status, 0);
  const std::string second = manifest("out")["reactions"][0]["digest"];
  EXPECT_NE(first, second);
  write("man.bvh", read("man.bvh") + "\n");
  EXPECT_EQ(batch("out", {"--resume"}).status, 0);
  EXPECT_NE(manifest("out")["reactions"][0]["digest"], second);
}

TEST_F(Batch, AFolderWithABatchIsNotOverwrittenUnasked) {
  EXPECT_EQ(batch("out").status, 0);
  expect_refused({"batch", "r.toml", "-o", "out"}, 2, "out: holds a batch already");
  const auto before = times("out");
  EXPECT_EQ(batch("out", {"--force"}).status, 0);
  EXPECT_EQ(changed("out", before).size(), 8u);
}

TEST_F(Batch, FailuresCostTheirReactionAloneAndAreListed) {
  write("bad.bvh", "HIERARCHY\nROOT");
  write("r.toml", std::string(kRecipe).replace(std::string(kRecipe).find("\"mannequin\""), 11,
                                               "\"mannequin\", \"bad.bvh\""));
  const Ran ran = batch("out");
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.out.find("8 done, 0 rejected, 8 failed"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("failed bad/head_left_0 and 7 more of this character: "), std::string::npos)
      << ran.out;
  EXPECT_EQ(ran.out.find("failed bad/", ran.out.find("failed bad/") + 1), std::string::npos) << "said twice";
  const Json failed = manifest("out")["reactions"].back();
  EXPECT_EQ(failed["status"], "failed");
  EXPECT_TRUE(failed["error"].is_string());
  EXPECT_TRUE(failed["outputs"].empty());
  EXPECT_TRUE(failed["figures"].is_null());
}

TEST_F(Batch, AWorkerThatTakesTooLongIsToldAsTheReason) {
  write("r.toml",
        "format = 1\ncharacters = [\"mannequin\"]\noutputs = [\"glb\"]\n[settings]\n"
        "rate = \"fixed:10000\"\nduration = 60\n[[reaction]]\n");
  const Ran ran = batch("out", {"--job-timeout", "0.2"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.out.find("took longer than 0.2 s, twice"), std::string::npos) << ran.out;
}

TEST_F(Batch, RejectsWhatLeavesTheRangeOrDoesNotSettle) {
  std::string limp = kRecipe;
  limp.replace(limp.find("[settings]"), 10, "[settings]\nbehaviour = \"limp\"");
  write("r.toml", limp);
  const Ran ran = batch("out", {"--reject-unsettled"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.out.find("0 done, 8 rejected, 0 failed"), std::string::npos) << ran.out;
  const Json rejected = manifest("out")["reactions"][0];
  EXPECT_EQ(rejected["status"], "rejected");
  EXPECT_EQ(rejected["figures"]["settled"], false);
  EXPECT_EQ(rejected["outputs"].size(), 2u);
  EXPECT_EQ(batch("out", {"--resume"}).status, 0);
  EXPECT_EQ(batch("out", {"--resume", "--max-excess", "0"}).status, 1);
}

TEST_F(Batch, AReviewersRejectsAreBakedAgainWithAnotherSeedOrLeftOut) {
  write("r.toml", std::string(kRecipe) + "[[reaction]]\nname = \"plain\"\n");
  EXPECT_EQ(batch("out").status, 0);
  const std::string digest = manifest("out")["reactions"][0]["digest"];
  write("v.json", R"({"format": 1, "rejects": [
    {"character": "mannequin", "name": "head_left_0", "comment": "odd", "digest": ")" +
                      digest + R"("},
    {"character": "mannequin", "name": "plain", "comment": "dull"}], "accepts": []})");
  const auto before = times("out");
  const Ran ran = batch("out", {"--rejects", "v.json"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.out.find("rejected mannequin/plain: left out by a reviewer: dull"), std::string::npos);
  EXPECT_EQ(changed("out", before), (std::set<std::string>{"head_left_0"}));
  EXPECT_EQ(manifest("out")["reactions"][0]["settings"]["seed"], 1);
  // The same verdicts again change nothing, nor does a resume.
  const auto after = times("out");
  batch("out", {"--rejects", "v.json"});
  batch("out", {"--resume"});
  EXPECT_TRUE(changed("out", after).empty());
  EXPECT_EQ(manifest("out")["reactions"][0]["settings"]["seed"], 1);
  write("v.json", R"({"format": 1, "accepts": [{"character": "mannequin", "name": "plain"}]})");
  EXPECT_EQ(batch("out", {"--rejects", "v.json"}).status, 0);
}

TEST_F(Batch, ADryRunListsEstimatesAndWritesNothing) {
  const Ran ran = run({"batch", "r.toml", "-o", "out", "--dry-run", "-j", "2"});
  EXPECT_EQ(ran.status, 0);
  EXPECT_NE(ran.out.find("bake      mannequin/head_left_0: head from "), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("8 to bake, 0 to keep, 0 left out; about "), std::string::npos) << ran.out;
  EXPECT_EQ(files(), std::vector<std::string>{"r.toml"});
}

TEST_F(Batch, SaysALineForEachReactionOrNothing) {
  const Ran lines = batch("out");
  EXPECT_EQ(std::count(lines.err.begin(), lines.err.end(), '\n'),
            kReactions + 1);  // and the note on behaviours
  EXPECT_NE(lines.err.find("8/8 mannequin/"), std::string::npos);
  const Ran quiet = batch("quiet", {"--quiet"});
  EXPECT_EQ(quiet.out + quiet.err, "");
  const Ran json = batch("json", {"--json"});
  EXPECT_EQ(json.out, read("json/manifest.json"));
}

TEST_F(Batch, TheTableOpensInASpreadsheet) {
  EXPECT_EQ(batch("out").status, 0);
  const std::string csv = read("out/manifest.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), kReactions + 1);
  EXPECT_EQ(csv.rfind("character,name,status,hit,from,", 0), 0u);
  EXPECT_NE(csv.find("\r\nmannequin,head_left_0,done,head,left,medicine-ball,"), std::string::npos) << csv;
}

TEST_F(Batch, TheLibraryIsATableForEngines) {
  EXPECT_EQ(batch("out").status, 0);
  const std::string csv = read("out/library.csv");
  const nlohmann::json rows = nlohmann::json::parse(read("out/library.json"));
  ASSERT_EQ(rows.size(), static_cast<std::size_t>(kReactions));
  EXPECT_EQ(csv.rfind("Name,Character,Reaction,Clip,File,Segment,", 0), 0u)
      << "an engine takes the first as key";
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), kReactions + 1);
  EXPECT_EQ(csv.find('"'), csv.npos) << "no cell needs quotes";
  std::ifstream unreal(fs::path(UKEMI_ASSETS_FOLDER) / "../tools/engines/unreal/UkemiReaction.h");
  std::string columns = "Name";
  for (std::string line; std::getline(unreal, line);)
    if (const auto at = line.find("BlueprintReadOnly) "); at != line.npos) {
      std::istringstream member(line.substr(at + 19));
      std::string type, name;
      member >> type >> name;
      columns += "," + name.substr(0, name.find(';'));
    }
  EXPECT_EQ(csv.substr(0, csv.find("\r\n")), columns) << "the row struct for Unreal";
  std::set<std::string> names;
  for (const auto& row : rows) {
    names.insert(row["Name"]);
    EXPECT_TRUE(fs::exists(folder / "out" / row["File"].get<std::string>()));
    for (const auto& [key, value] : row.items()) EXPECT_TRUE(value.is_primitive() && !value.is_null()) << key;
    EXPECT_NE(csv.find("\r\n" + row["Name"].get<std::string>() + ","), csv.npos);
  }
  EXPECT_EQ(names.size(), rows.size()) << "each name once";
  const auto blow = std::find_if(rows.begin(), rows.end(),
                                 [](const auto& row) { return row["Name"] == "mannequin_head_left_0"; });
  ASSERT_NE(blow, rows.end());
  EXPECT_EQ((*blow)["From"], "left");
  EXPECT_GT((*blow)["PeakHeadSpeed"].get<double>(), 0.5);
}

TEST_F(Batch, TheLibrarySaysWhatReviewersSaid) {
  EXPECT_EQ(batch("out").status, 0);
  write("verdicts.json",
        R"({"format": 1, "rejects": [], "accepts": [{"character": "mannequin", "name": "head_left_0"}]})");
  EXPECT_EQ(batch("out", {"--resume", "--rejects", (folder / "verdicts.json").string()}).status, 0);
  EXPECT_EQ(batch("out", {"--resume"}).status, 0);
  int accepted = 0;
  for (const auto& row : nlohmann::json::parse(read("out/library.json"))) {
    EXPECT_EQ(row["Verdict"] == "accepted", row["Name"] == "mannequin_head_left_0");
    accepted += row["Verdict"] == "accepted" ? 1 : 0;
  }
  EXPECT_EQ(accepted, 1);
}

TEST_F(Batch, AFullDiskStopsItAndLosesNothing) {
  fs::create_directory(folder / "small");
  if (mount("tmpfs", (folder / "small").c_str(), "tmpfs", 0, "size=100k") != 0)
    GTEST_SKIP() << "a small disk needs the right to mount one";
  const Ran full = batch("small/out", {"-j", "2"});
  EXPECT_EQ(full.status, 4);
  EXPECT_NE(full.err.find("No space left on device"), std::string::npos) << full.err;
  EXPECT_NE(full.err.find("--resume"), std::string::npos) << full.err;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "small/out/mannequin"))
    EXPECT_GT(entry.file_size(), 1000u) << entry.path();
  EXPECT_EQ(mount("tmpfs", (folder / "small").c_str(), "tmpfs", MS_REMOUNT, "size=64m"), 0);
  EXPECT_EQ(batch("small/out", {"--resume"}).status, 0);
  EXPECT_EQ(batch("direct").status, 0);
  expect_same("direct", "small/out");
  EXPECT_EQ(umount((folder / "small").c_str()), 0);
}

TEST_F(Batch, RefusesBeforeAnythingIsMade) {
  expect_refused({"batch", "r.toml"}, 2, "no output");
  expect_refused({"batch", "none.toml", "-o", "out"}, 2, "none.toml: cannot read");
  expect_refused({"batch", "r.toml", "-o", "r.toml"}, 4, "r.toml");
  expect_refused({"batch", "r.toml", "-o", "/proc/out"}, 4, "/proc/out");
  expect_refused({"batch", "r.toml", "-o", "out", "-j", "0"}, 2, "--jobs: '0' is not a whole number");
  expect_refused({"batch", "r.toml", "-o", "out", "--shard", "3/2"}, 2, "--shard: '3/2' is not I/N");
  expect_refused({"batch", "r.toml", "-o", "out", "--resume", "--force"}, 2, "exclude each other");
  expect_refused({"batch", "r.toml", "-o", "out", "--merge", "none"}, 2, "there is no such folder");
  expect_refused({"batch", "r.toml", "-o", "out", "--rejects", "r.toml"}, 2, "not a list of verdicts");
  write("r.toml", "format = 1\ncharacters = [\"mannequin\"]\n[[matrix]]\nhti = [\"head\"]\n");
  expect_refused({"batch", "r.toml", "-o", "out"}, 2, "r.toml:4:1: unknown setting 'hti'");
}

TEST_F(Batch, EndsWithTheReviewPage) {
  write(
      "r.toml",
      "format = 1\ncharacters = [\"mannequin\"]\n[settings]\nduration = 0.1\n[[reaction]]\nname = \"one\"\n");
  EXPECT_EQ(run({"batch", "r.toml", "-o", "out"}).status, 0);
  EXPECT_GT(fs::file_size(folder / "out/index.html"), 100u);
  EXPECT_GT(fs::file_size(folder / "out/mannequin/one.png"), 10000u);
  EXPECT_EQ(run({"batch", "r.toml", "-o", "without", "--no-review"}).status, 0);
  EXPECT_FALSE(fs::exists(folder / "without/index.html"));
}

TEST_F(Batch, AFileThatWasChangedIsBakedAgain) {
  EXPECT_EQ(batch("out").status, 0);
  const std::string name =
      "out/mannequin/" + manifest("out")["reactions"][0]["name"].get<std::string>() + ".bvh";
  const std::string whole = read(name);
  std::string changed = whole;
  ASSERT_FALSE(changed.empty());
  changed.back() = changed.back() == '1' ? '2' : '1';  // of the same size
  write(name, changed);
  EXPECT_EQ(batch("out", {"--resume"}).status, 0);
  EXPECT_EQ(read(name), whole);
}

TEST_F(Batch, ASpreadsheetDoesNotRunNames) {
  write("r.toml",
        "format = 1\ncharacters = [\"mannequin\"]\noutputs = [\"bvh\"]\n[settings]\nduration = 0.1\n"
        "[[reaction]]\nname = \"=1+1\"\n");
  EXPECT_EQ(batch("out").status, 0);
  const std::string table = read("out/manifest.csv");
  EXPECT_EQ(table.find(",=1+1"), table.npos) << table;
}

TEST_F(Batch, ThePageIsMadeAgainWhenItWouldDifferAndLeftAloneElse) {
  const std::string recipe =
      "format = 1\ncharacters = [\"mannequin\"]\n[settings]\nduration = 0.1\n[[reaction]]\nname = \"one\"\n";
  write("r.toml", recipe);
  const std::vector<std::string> again = {"batch", "r.toml", "-o", "out", "--resume"};
  EXPECT_EQ(run({"batch", "r.toml", "-o", "out"}).status, 0);
  const auto page = [&] {
    std::map<std::string, fs::file_time_type> times = {
        {"index.html", fs::last_write_time(folder / "out/index.html")}};
    for (const auto& entry : fs::recursive_directory_iterator(folder / "out/review"))
      if (entry.is_regular_file()) times[entry.path().string()] = entry.last_write_time();
    return times;
  };
  const auto first = page();
  ASSERT_GE(first.size(), 8u);
  EXPECT_EQ(run(again).status, 0);
  EXPECT_EQ(page(), first) << "nothing has changed";

  write("r.toml", recipe + "[[reaction]]\nname = \"two\"\n");
  EXPECT_EQ(run({"batch", "r.toml", "-o", "out", "--resume", "--no-review"}).status, 0);
  EXPECT_EQ(page(), first) << "no page was asked for";
  EXPECT_EQ(run(again).status, 0);
  const auto second = page();
  EXPECT_GT(second.at("index.html"), first.at("index.html"))
      << "the manifest has changed since the page was made";

  fs::remove(folder / "out/mannequin/two.glb");
  EXPECT_EQ(run({"batch", "r.toml", "-o", "out", "--resume", "--no-review"}).status, 0);
  EXPECT_EQ(run(again).status, 0);
  const auto third = page();
  EXPECT_GT(third.at("index.html"), second.at("index.html")) << "a clip is newer than the page";

  write("out/review/review.js", "of an older program");
  EXPECT_EQ(run(again).status, 0);
  EXPECT_GT(page().at("index.html"), third.at("index.html")) << "the page's program has changed";
}

TEST_F(Batch, ARecipeCannotWriteOutsideTheFolder) {
  write("r.toml",
        "format = 1\ncharacters = [\"mannequin\"]\noutputs = [\"bvh\"]\n[settings]\nduration = 0.1\n"
        "[[reaction]]\nname = \"../../outside\"\n[[reaction]]\nname = \"/tmp/outside\"\n");
  EXPECT_EQ(batch("out").status, 0);
  EXPECT_EQ(files(), (std::vector<std::string>{"out", "r.toml"}));
}

TEST_F(Batch, ThePrintedRecipeCanBeBakedAsItIs) {
  const Ran printed = run({"recipe"});
  EXPECT_EQ(printed.status, 0);
  write("r.toml", printed.out);
  EXPECT_EQ(run({"batch", "r.toml", "-o", "out", "--dry-run"}).status, 0);
}

TEST_F(Batch, TheSettingsComeAsData) {
  const Ran printed = run({"recipe", "--json"});
  EXPECT_EQ(printed.status, 0);
  const auto json = nlohmann::json::parse(printed.out);
  EXPECT_EQ(json["settings"][0]["name"], "hit");
  EXPECT_EQ(json["settings"][0]["default"], "chest");
  EXPECT_NE(json["settings"][0]["choices"], nullptr);
}

TEST_F(Batch, ADryRunSaysWhatIsWrongWithACharacterOnce) {
  write("bad.bvh", "HIERARCHY\nROOT");
  const std::string begin = "format = 1\ncharacters = [\"mannequin\", \"bad.bvh\"]\n";
  const std::string matrix = "[[matrix]]\nhit = [\"head\", \"chest\"]\nfrom = [\"front\", \"back\"]\n";
  write("r.toml", begin + matrix);
  Ran ran = run({"batch", "r.toml", "-o", "out", "--dry-run"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.err.find("(stops 4 reactions of 'bad')"), std::string::npos) << ran.err;
  EXPECT_EQ(ran.err.find("error"), ran.err.rfind("error")) << "said once: " << ran.err;
  EXPECT_NE(ran.out.find("8 to bake"), std::string::npos) << ran.out;
  for (const auto& [setting, word] :
       {std::pair("clip = \"nosuch\"\n", "nosuch"), {"map = [\"head=Nobody\"]\n", "Nobody"}}) {
    write("r.toml", std::string("format = 1\ncharacters = [\"mannequin\"]\n[settings]\n") + setting + matrix);
    ran = run({"batch", "r.toml", "-o", "out", "--dry-run"});
    EXPECT_EQ(ran.status, 1) << word;
    EXPECT_NE(ran.err.find(word), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("(stops 4 reactions of 'mannequin')"), std::string::npos) << ran.err;
  }
}

}  // namespace
}  // namespace ukemi
