// The program on a full disk, without permission, killed, twice at once, and in odd surroundings.
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "cli/program.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

/// Runs shell scripts in the test's folder; $UKEMI is the program.
class Surroundings : public Program {
 protected:
  struct Shell {
    int status = -1;
    std::string err;
  };

  Shell shell(const std::string& script) {
    const fs::path file = folder.string() + ".sh";
    const fs::path err = folder.string() + ".err";
    std::ofstream(file) << "cd '" << folder.string() << "'\nUKEMI='" << UKEMI_PROGRAM << "'\n"
                        << script << '\n';
    const int status = std::system(("sh '" + file.string() + "' 2>'" + err.string() + "'").c_str());
    std::ifstream said(err);
    Shell result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, {std::istreambuf_iterator<char>(said), {}}};
    fs::remove(file);
    fs::remove(err);
    return result;
  }

  /// The bytes of a.glb, a.bvh and a.png that the script makes, and that it leaves nothing else.
  std::string baked(const std::string& script) {
    const Shell result = shell(script);
    EXPECT_EQ(result.status, 0) << script << '\n' << result.err;
    std::string bytes;
    for (const char* name : {"a.glb", "a.bvh", "a.png"}) {
      EXPECT_FALSE(read(name).empty()) << script << ": " << name;
      bytes += read(name);
      fs::remove(folder / name);
    }
    EXPECT_TRUE(files().empty()) << script;
    return bytes;
  }

  /// The bytes of every file that the script puts into out, which is removed.
  std::string digest_of_batch(const std::string& script) {
    const Shell result = shell(script);
    EXPECT_EQ(result.status, 0) << script << '\n' << result.err;
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "out"))
      if (entry.is_regular_file() && entry.path().parent_path().filename() != ".ukemi")
        names.push_back(fs::relative(entry.path(), folder).string());
    std::sort(names.begin(), names.end());
    EXPECT_EQ(names.size(), 4u * 3u + 4u) << script;
    std::string bytes;
    for (const std::string& name : names) bytes += name + '\n' + read(name);
    fs::remove_all(folder / "out");
    return bytes;
  }

  static bool is_root() { return geteuid() == 0; }
};

constexpr const char* kShort = " bake mannequin --duration 0.2 --quiet ";
constexpr const char* kThree = " bake mannequin --duration 0.2 -o a.glb -o a.bvh --sheet a.png ";

TEST_F(Surroundings, AFullDiskLeavesTheOldFilesAndNothingElse) {
  write("a.bvh", "old");
  // At most 64 blocks of 512 bytes in one file: the .bvh fits, the .glb does not.
  const Shell result =
      shell(std::string("ulimit -f 64\n$UKEMI") + kShort + "-o a.bvh -o a.glb --report a.json");
  EXPECT_EQ(result.status, 4) << result.err;
  EXPECT_NE(result.err.find("a.glb: cannot write: File too large"), std::string::npos) << result.err;
  EXPECT_EQ(files(), std::vector<std::string>{"a.bvh"});
  EXPECT_EQ(read("a.bvh"), "old");
}

TEST_F(Surroundings, WhatIsNoFileIsRefusedBeforeAnythingRuns) {
  fs::create_directory(folder / "folder.glb");
  ASSERT_EQ(mkfifo((folder / "pipe.glb").c_str(), 0600), 0);
  fs::create_symlink("loop.glb", folder / "loop.glb");
  const std::string endless = " bake mannequin --duration 60 --no-until-rest --rate fixed:10000 -o ";
  const std::string long_name = std::string(300, 'n') + ".glb";
  for (const std::string name : {"folder.glb", "pipe.glb", "loop.glb", "none/a.glb", long_name.c_str()}) {
    const Shell result = shell("timeout 20 $UKEMI" + endless + name);
    EXPECT_EQ(result.status, 4) << name << result.err;
    EXPECT_NE(result.err.find("cannot write"), std::string::npos) << result.err;
  }
  EXPECT_EQ(files(), (std::vector<std::string>{"folder.glb", "loop.glb", "pipe.glb"}));
}

TEST_F(Surroundings, ARunThatDivergesOnceIsThatOfTwiceTheRateAndSaysSo) {
  const std::string bake =
      "$UKEMI bake mannequin --hit hand_l --ball-mass 10 --ball-speed 60 --duration 0.4 ";
  const Shell twice = shell(bake + "--quiet --rate fixed:120 -o twice.glb");
  ASSERT_EQ(twice.status, 0) << twice.err;
  const Shell once = shell(bake + "--rate fixed:60 -o once.glb --report once.json >/dev/null");
  ASSERT_EQ(once.status, 0) << once.err;
  EXPECT_NE(once.err.find("warning: hand_l: the simulation diverged at 0.000 s"), std::string::npos)
      << once.err;
  EXPECT_NE(once.err.find("it is run again at twice the rate"), std::string::npos) << once.err;
  EXPECT_NE(read("once.json").find("it is run again at twice the rate"), std::string::npos);
  EXPECT_EQ(read("once.glb"), read("twice.glb"));
}

TEST_F(Surroundings, EveryCommandLeavesNothingPartialOnAFullDisk) {
  ASSERT_EQ(shell("$UKEMI bake mannequin --duration 0.1 --quiet -o one.glb").status, 0);
  fs::create_directory(folder / "small");
  if (mount("tmpfs", (folder / "small").c_str(), "tmpfs", 0, "size=8k") != 0)
    GTEST_SKIP() << "a small disk needs the right to mount one";
  write("small/old.png", "old");
  const std::vector<std::string> commands = {
      "bake mannequin --duration 0.1 -o small/a.bvh -o small/b.glb --sheet small/old.png --report "
      "small/r.json",
      "render mannequin --cells 1 -o small/old.png",
      "render mannequin --cells 1 -o small/new.png",
      "render mannequin --size thumbnail -o small/new.webp",
      "rom -o small/old.png",
      "compare mannequin --hits 1 --duration 0.2 --quiet -o small/compared"};
  for (const std::string& command : commands) {
    const Shell result = shell("$UKEMI " + command + " >/dev/null");
    EXPECT_EQ(result.status, 4) << command << '\n' << result.err;
    EXPECT_NE(result.err.find("cannot write: No space left on device\n  fix: "), std::string::npos)
        << result.err;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "small"), fs::directory_iterator()), 1)
        << command;
    EXPECT_EQ(read("small/old.png"), "old") << command;
  }
  EXPECT_EQ(mount("tmpfs", (folder / "small").c_str(), "tmpfs", MS_REMOUNT, "size=1200k"), 0);
  fs::copy_file(folder / "one.glb", folder / "small/one.glb");
  const Shell review = shell("$UKEMI review small >/dev/null");
  EXPECT_EQ(review.status, 4) << review.err;
  EXPECT_FALSE(fs::exists(folder / "small/index.html") || fs::exists(folder / "small/review"));
  EXPECT_EQ(read("small/one.glb"), read("one.glb"));
  EXPECT_EQ(mount("tmpfs", (folder / "small").c_str(), "tmpfs", MS_REMOUNT, "size=64m"), 0);
  EXPECT_EQ(shell("$UKEMI review small >/dev/null").status, 0) << "the same once there is space";
  EXPECT_TRUE(fs::exists(folder / "small/index.html"));
  EXPECT_EQ(umount((folder / "small").c_str()), 0);
}

TEST_F(Surroundings, ALinkIsWrittenThrough) {
  fs::create_directory(folder / "real");
  write("real/a.glb", "old");
  fs::create_symlink("real/a.glb", folder / "a.glb");
  ASSERT_EQ(shell(std::string("$UKEMI") + kShort + "-o a.glb").status, 0);
  EXPECT_TRUE(fs::is_symlink(folder / "a.glb"));
  EXPECT_TRUE(read("real/a.glb").starts_with("glTF"));
}

TEST_F(Surroundings, AFolderWithoutPermissionIsRefused) {
  const std::string as_nobody = is_root() ? "setpriv --reuid 65534 --regid 65534 --clear-groups " : "";
  if (is_root() && shell(as_nobody + "test -x \"$UKEMI\"").status != 0)
    GTEST_SKIP() << "another user cannot reach the program";
  fs::create_directory(folder / "closed");
  fs::permissions(folder / "closed", fs::perms::owner_read | fs::perms::owner_exec);
  const Shell result = shell(as_nobody + "$UKEMI" + kShort + "-o closed/a.glb");
  fs::permissions(folder / "closed", fs::perms::owner_all);
  EXPECT_EQ(result.status, 4) << result.err;
  EXPECT_NE(result.err.find("may not be written to"), std::string::npos) << result.err;
  EXPECT_TRUE(fs::is_empty(folder / "closed"));
}

TEST_F(Surroundings, TwoBakesIntoOneFileNeverMix) {
  std::vector<std::string> whole;
  for (const char* hit : {"head", "shank_l"}) {
    ASSERT_EQ(shell(std::string("$UKEMI") + kShort + "-o one.glb --hit " + hit).status, 0);
    whole.push_back(read("one.glb"));
  }
  ASSERT_NE(whole[0], whole[1]);
  for (int i = 0; i < 3; ++i) {
    const std::string bake = std::string("$UKEMI") + kShort + "-o one.glb --hit ";
    ASSERT_EQ(shell(bake + "head & " + bake + "shank_l && wait $!").status, 0);
    EXPECT_TRUE(std::find(whole.begin(), whole.end(), read("one.glb")) != whole.end());
    EXPECT_EQ(files(), std::vector<std::string>{"one.glb"});
  }
}

TEST_F(Surroundings, AKilledBakeLeavesTheOldFileOrTheNewOne) {
  ASSERT_EQ(shell(std::string("$UKEMI") + kShort + "-o new.glb").status, 0);
  const std::string fresh = read("new.glb");
  int counted = 0;
  for (const char* seconds : {"0.02", "0.05", "0.1", "0.15", "0.2", "0.3", "0.5"}) {
    write("a.glb", "old");
    static_cast<void>(shell("timeout -s KILL " + std::string(seconds) + " $UKEMI" + kShort + "-o a.glb"));
    const std::string left = read("a.glb");
    EXPECT_TRUE(left == "old" || left == fresh) << "after " << seconds << " s: " << left.size() << " bytes";
    ++counted;
  }
  EXPECT_EQ(counted, 7);
}

TEST_F(Surroundings, TheSameBytesWithoutHomeTerminalOrStreamsInAnyLocaleAndFolder) {
  const std::string reference = baked(std::string("$UKEMI") + kThree + ">/dev/null");
  EXPECT_EQ(baked(std::string("env -i $UKEMI") + kThree + ">/dev/null"), reference) << "without environment";
  EXPECT_EQ(baked(std::string("LC_ALL=de_DE.UTF-8 LANG=tr_TR.UTF-8 $UKEMI") + kThree + ">/dev/null"),
            reference);
  EXPECT_EQ(baked(std::string("$UKEMI") + kThree + "<&- >&-"), reference) << "stdin and stdout closed";
  EXPECT_EQ(baked(std::string("$UKEMI") + kThree + "<&- >&- 2>&-"), reference) << "all closed";
  const std::string here = folder.string() + "/";
  EXPECT_EQ(baked("cd /; $UKEMI bake mannequin --duration 0.2 -o " + here + "a.glb -o " + here +
                  "a.bvh --sheet " + here + "a.png >/dev/null"),
            reference)
      << "from another folder";
}

TEST_F(Surroundings, ABatchIsTheSameInAnyLocaleFolderAndNumberOfWorkersWithoutHomeOrStreams) {
  fs::create_directory(folder / "recipes");
  write("recipes/r.toml",
        "format = 1\ncharacters = [\"mannequin\"]\noutputs = [\"glb\", \"bvh\", \"sheet\"]\n[settings]\n"
        "duration = 0.1\n[[matrix]]\nhit = [\"head\", \"chest\"]\nvariations = 2\njitter = { direction-deg = "
        "10 }\n");
  const std::string reference =
      digest_of_batch("cd recipes; $UKEMI batch r.toml -o ../out -j 1 --no-review >/dev/null 2>&1");
  const std::vector<std::string> ways = {
      "$UKEMI batch recipes/r.toml -o out -j 2 --no-review </dev/null >/dev/null",
      "env -i $UKEMI batch recipes/r.toml -o out -j 2 --no-review >/dev/null",
      "LC_ALL=de_DE.UTF-8 LANG=tr_TR.UTF-8 $UKEMI batch recipes/r.toml -o out -j 2 --no-review >/dev/null",
      "$UKEMI batch recipes/r.toml -o out -j 1 --no-review <&- >&- 2>&-",
      "cd /; $UKEMI batch " + (folder / "recipes/r.toml").string() + " -o " + (folder / "out").string() +
          " -j 2 --no-review >/dev/null"};
  for (const std::string& way : ways) EXPECT_EQ(digest_of_batch(way), reference) << way;
  if (!is_root()) return;
  fs::permissions(folder, fs::perms::all);
  fs::permissions(folder / "recipes", fs::perms::all);
  const std::string as_nobody = "setpriv --reuid 65534 --regid 65534 --clear-groups ";
  if (shell(as_nobody + "test -x \"$UKEMI\"").status == 0) {
    EXPECT_EQ(digest_of_batch(as_nobody + ways[0]), reference) << "as another user";
  }
}

TEST_F(Surroundings, TheSameBytesAsAnotherUser) {
  if (!is_root()) GTEST_SKIP() << "only root can become another user";
  const std::string as_nobody = "setpriv --reuid 65534 --regid 65534 --clear-groups ";
  if (shell(as_nobody + "test -x \"$UKEMI\"").status != 0)
    GTEST_SKIP() << "another user cannot reach the program";
  const std::string reference = baked(std::string("$UKEMI") + kThree + ">/dev/null");
  fs::permissions(folder, fs::perms::all);
  EXPECT_EQ(baked(as_nobody + "$UKEMI" + kThree + ">/dev/null"), reference);
}

TEST_F(Surroundings, ASourceFolderThatIsReadOnlyIsNotWrittenTo) {
  fs::create_directory(folder / "source");
  fs::copy_file(fs::path(UKEMI_ASSETS_FOLDER) / "characters" / "mannequin.glb",
                folder / "source" / "hero.glb");
  fs::permissions(folder / "source", fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                                         fs::perms::others_exec);
  const Shell result = shell(
      "$UKEMI bake source/hero.glb --duration 0.2 --quiet -o a.glb && $UKEMI inspect source/hero.glb "
      ">/dev/null");
  const auto left = std::distance(fs::directory_iterator(folder / "source"), fs::directory_iterator());
  fs::permissions(folder / "source", fs::perms::owner_all);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(left, 1);
}

}  // namespace
}  // namespace ukemi
