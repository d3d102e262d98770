// Bad command lines and bad files: a message that names the thing and the fix, the exit status, nothing
// written.
#include <algorithm>
#include <fstream>
#include <regex>

#include "program.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

constexpr int kMustChange = 2;
constexpr int kCannotWrite = 4;

using Refusal = Program;

const char* const kBox =
    R"({"asset":{"version":"2.0"},"nodes":[{"name":"box"}],"scenes":[{"nodes":[0]}],"scene":0})";

TEST_F(Refusal, OfNoOrUnknownCommands) {
  expect_refused({}, kMustChange, "no command");
  expect_refused({"bkae"}, kMustChange, "unknown command 'bkae'\n  fix: did you mean 'bake'?");
  expect_refused({"xyzzyx"}, kMustChange,
                 "choose one of: bake batch recipe inspect render review compare judge");
  expect_refused({"--vresion"}, kMustChange, "unknown option '--vresion'");
}

TEST_F(Refusal, OfUnknownOptionsAndArguments) {
  expect_refused({"bake", "mannequin", "--preest", "kick", "-o", "a.glb"}, kMustChange,
                 "did you mean '--preset'?");
  expect_refused({"bake", "mannequin", "other.glb", "-o", "a.glb"}, kMustChange,
                 "unexpected argument 'other.glb'");
  expect_refused({"bake", "-o", "a.glb"}, kMustChange, "CHARACTER is missing");
  expect_refused({"diff", "a.glb"}, kMustChange, "B is missing");
  expect_refused({"inspect"}, kMustChange, "FILE is missing");
}

TEST_F(Refusal, OfUnknownWords) {
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--hit", "haed"}, kMustChange, "did you mean 'head'?");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--from", "letf"}, kMustChange, "did you mean 'left'?");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--preset", "kcik"}, kMustChange,
                 "did you mean 'kick'?");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--scene", "trampoline"}, kMustChange, "'trampoline'");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--pose", "sit"}, kMustChange, "unknown pose 'sit'");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--limits", "edge"}, kMustChange,
                 "did you mean 'edges'?");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--active", "on"}, kMustChange,
                 "--active: unknown word 'on'");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--rate", "fast"}, kMustChange,
                 "--rate: unknown word 'fast'");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--map", "head"}, kMustChange,
                 "'head' is not SEGMENT=NODE");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--map", "haed=Head"}, kMustChange,
                 "did you mean 'head'?");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--map", "head=NoSuchNode"}, kMustChange, "NoSuchNode");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--region", "humna"}, kMustChange, "humna");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--unit", "parsec"}, kMustChange,
                 "'parsec' is not a unit");
}

TEST_F(Refusal, OfClipSettingsThatDoNotGoTogether) {
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--recover", "0.5", "--to", "stance"}, kMustChange,
                 "exclude each other");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--recover", "0.5", "--to", "clip"}, kMustChange,
                 "--return-to clip needs a start clip");
  expect_refused({"bake", "mannequin", "-o", "a.bvh", "--additive", "rest"}, kMustChange,
                 "--additive is for glTF");
  expect_refused({"bake", "mannequin", "-o", "a.fbx", "--additive", "identity"}, kMustChange,
                 "--additive is for glTF");
  expect_refused({"bake", "mannequin", "-o", "a.bvh", "--append"}, kMustChange, "--append is for glTF");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--smooth", "30"}, kMustChange,
                 "--smooth 30 is not below half of the 60 frames per second");
}

TEST_F(Refusal, OfGetUpClipsInWhichNobodyGetsUp) {
  const std::string mannequin = std::string(UKEMI_ASSETS_FOLDER) + "/characters/mannequin.glb";
  const auto with = [](const std::string& clip) {
    return std::vector<std::string>{"bake", "mannequin", "-o", "a.glb", "--get-up-clip", clip};
  };
  expect_refused(with(mannequin), kMustChange,
                 "nobody gets up from the floor in it: looked at mannequin.glb: ");
  expect_refused(with(mannequin + "#walk"), kMustChange, "looked at mannequin.glb: walk\n");
  expect_refused(with(mannequin + "#wlak"), kMustChange, "did you mean 'walk'?");
  expect_refused(with("missing.glb"), kMustChange, "missing.glb");
  fs::create_directory(folder / "empty");
  expect_refused(with("empty"), kMustChange, "holds no file with motion");
  write("box.gltf", kBox);
  expect_refused(with("box.gltf"), kMustChange, "not a humanoid");
}

TEST_F(Refusal, OfOptionsThatWouldDoNothing) {
  expect_refused({"bake", "mannequin", "-o", "a.vrma", "--append"}, kMustChange,
                 "--append is for glTF and FBX");
  const auto drawn = [&](std::vector<std::string> more, const char* said) {
    more.insert(more.begin(), {"render", "mannequin"});
    expect_refused(more, kMustChange, said);
  };
  drawn({"-o", "a.png", "--fps", "10"}, "--fps is for moving pictures");
  drawn({"-o", "a.png", "--speed", "0.5"}, "--speed is for moving pictures");
  drawn({"-o", "a.png", "--turntable", "4"}, "--turntable is for moving pictures");
  drawn({"-o", "a.webp", "--cells", "4"}, "are for sheets");
  drawn({"-o", "a.png", "--region", "box"}, "--region needs --rom");
  for (const auto& [option, value] : {std::pair("--height", "1.8"),
                                      {"--map", "head=Head"},
                                      {"--unit", "cm"},
                                      {"--up", "y"},
                                      {"--root", "#0"}})
    expect_refused({"rom", option, value}, kMustChange, std::string(option) + " needs --check");
  expect_refused({"judge", "mannequin", "--impact", "0.1", "--from", "0.2"}, kMustChange,
                 "--impact and --from exclude each other");
  expect_refused({"compare", "mannequin", "--show", "1"}, kMustChange, "--show needs a folder");
}

TEST_F(Refusal, OfAFileOfAnotherSkeletonToAppendTo) {
  write("box.gltf", kBox);
  expect_refused({"bake", "mannequin", "-o", "box.gltf", "--append"}, kMustChange, "holds another skeleton");
}

TEST_F(Refusal, OfNumbersOutOfRange) {
  const std::pair<const char*, const char*> numbers[] = {
      {"--mass", "-70"},     {"--mass", "0"},         {"--ball-mass", "-5"}, {"--ball-mass", "1e9"},
      {"--ball-speed", "0"}, {"--ball-radius", "-1"}, {"--duration", "0"},   {"--duration", "3600"},
      {"--fps", "0"},        {"--fps", "-30"},        {"--fps", "1e6"},      {"--hold", "-1"},
      {"--active-k", "0"},   {"--damping", "-1"},     {"--rate", "fixed:0"}, {"--key-error-mm", "0"},
      {"--height", "0"},     {"--at", "-1"},          {"--fps", "sixty"},    {"--duration", "nan"},
  };
  for (const auto& [option, value] : numbers)
    expect_refused({"bake", "mannequin", "-o", "a.glb", option, value}, kMustChange,
                   std::string(option) + ": ");
}

TEST_F(Refusal, OfCharactersThatCannotBeRead) {
  write("empty.glb", "");
  write("empty.bvh", "");
  write("text.doc", "hello");
  write("noise.glb", std::string(1000, '\x5a'));
  fs::create_directory(folder / "folder.glb");
  expect_refused({"bake", "missing.glb", "-o", "a.glb"}, kMustChange, "missing.glb: cannot read");
  expect_refused({"bake", "text.doc", "-o", "a.glb"}, kMustChange, "text.doc");
  expect_refused({"bake", "empty.glb", "-o", "a.glb"}, kMustChange, "empty.glb");
  expect_refused({"bake", "empty.bvh", "-o", "a.glb"}, kMustChange, "empty.bvh");
  expect_refused({"bake", "noise.glb", "-o", "a.glb"}, kMustChange, "noise.glb");
  expect_refused({"bake", "folder.glb", "-o", "a.glb"}, kMustChange, "folder.glb: is a directory");
  expect_refused({"render", "missing.glb", "-o", "a.png"}, kMustChange, "missing.glb");
  expect_refused({"diff", "missing.glb", "mannequin"}, kMustChange, "missing.glb");
}

TEST_F(Refusal, OfAFileThatIsNoHumanoid) {
  write("box.gltf", kBox);
  expect_refused({"bake", "box.gltf", "-o", "a.glb"}, kMustChange, "not a humanoid");
}

TEST_F(Refusal, OfOutputsThatCannotBe) {
  fs::create_directory(folder / "folder.glb");
  expect_refused({"bake", "mannequin"}, kMustChange, "nothing to write");
  expect_refused({"bake", "mannequin", "-o", "a.obj"}, kMustChange, "a.obj: unknown output format");
  expect_refused({"bake", "mannequin", "--sheet", "a.gif"}, kMustChange, "a.gif: unknown picture format");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "-o", "./a.glb"}, kMustChange, "named twice");
  expect_refused({"bake", "mannequin", "-o", "folder.glb"}, kCannotWrite, "is a directory");
  expect_refused({"bake", "mannequin", "-o", "none/a.glb"}, kCannotWrite, "there is no folder 'none'");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--report", "none/a.json"}, kCannotWrite, "none");
  expect_refused({"bake", "mannequin", "-o", "/proc/a.glb"}, kCannotWrite, "/proc/a.glb: cannot write");
  expect_refused({"render", "mannequin"}, kMustChange, "no output");
  expect_refused({"render", "mannequin", "-o", "a.jpg"}, kMustChange, "unknown picture format");
  expect_refused({"bake", "mannequin", "--json", "--quiet", "-o", "a.glb"}, kMustChange,
                 "exclude each other");
}

TEST_F(Refusal, OfAStdoutThatIsFull) {
  const Ran result = run({"--help"}, "/dev/full");
  EXPECT_EQ(result.status, kCannotWrite);
  EXPECT_NE(result.err.find("cannot write to stdout"), std::string::npos) << result.err;
}

TEST_F(Refusal, OfARegionFileNamesTheLine) {
  write("region.toml", "format = 1\n\n[joint.knee_l]\npolygon = \"none\"\n");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--region", "region.toml"}, kMustChange,
                 "region.toml:");
}

TEST_F(Refusal, OfStartsThatContradictEachOther) {
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--at", "0.5"}, kMustChange, "--at needs a clip");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--clip", "walk", "--pose", "rest"}, kMustChange,
                 "exclude");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--clip", "wakl"}, kMustChange, "did you mean 'walk'?");
  expect_refused({"bake", "mannequin", "-o", "a.glb", "--clip", "walk", "--at", "99"}, kMustChange,
                 "outside the clip");
}

using Help = Program;

TEST_F(Help, GoesToStdoutWithStatusZero) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--help"},
                                             {"bake", "--help"},
                                             {"inspect", "-h"},
                                             {"render", "--help"},
                                             {"diff", "--help"},
                                             {"rom", "--help"},
                                             {"review", "--help"},
                                             {"calibrate", "--help"},
                                             {"--version"}}) {
    const Ran result = run(arguments);
    EXPECT_EQ(result.status, 0) << arguments.front();
    EXPECT_NE(result.out, "");
    EXPECT_EQ(result.err, "");
  }
  EXPECT_TRUE(files().empty());
}

TEST_F(Help, NamesEveryCommandAndOnlyThose) {
  const std::string text = run({"--help"}).out;
  for (const char* command :
       {"bake CHARACTER", "inspect FILE", "render FILE", "judge CLIP", "diff A B", "compare CHARACTER",
        "review DIR", "rom", "calibrate FILE...", "batch RECIPE", "recipe", "help TOPIC"})
    EXPECT_NE(text.find(command), std::string::npos) << command;
}

TEST_F(Help, HasPagesToReadThatTheOverviewNames) {
  const std::string overview = run({"--help"}).out;
  std::size_t pages = 0;
  for (const auto& page : fs::directory_iterator(UKEMI_ASSETS_FOLDER "/help")) {
    const std::string topic = page.path().stem().string();
    const Ran printed = run({"help", topic});
    EXPECT_EQ(printed.status, 0) << printed.err;
    EXPECT_EQ(printed.out.rfind("# ", 0), 0u) << printed.out;
    EXPECT_NE(overview.find(topic), std::string::npos) << topic;
    ++pages;
  }
  EXPECT_GE(pages, 7u);
  EXPECT_EQ(run({"help"}).out, overview);
  expect_refused({"help", "blendre"}, kMustChange, "did you mean 'blender'?");
  expect_refused({"help", "blender", "batch"}, kMustChange, "more than one topic");
}

TEST_F(Help, OfACommandIsThatOfItsOption) {
  EXPECT_EQ(run({"help", "bake"}).out, run({"bake", "--help"}).out);
  expect_refused({"help", "bkae"}, kMustChange, "did you mean 'bake'?");
}

TEST_F(Help, OfABakeIsShortUnlessAllIsAskedFor) {
  const std::string everyday = run({"bake", "--help"}).out;
  EXPECT_LT(std::count(everyday.begin(), everyday.end(), '\n'), 55);
  for (const char* option : {"--hit ", "--from ", "--preset ", "--strength ", "--pre-roll,", "--output "})
    EXPECT_NE(everyday.find(option), std::string::npos) << option;
  EXPECT_EQ(everyday.find("--active-k"), std::string::npos);
  EXPECT_NE(run({"bake", "--help-all"}).out.find("--active-k"), std::string::npos);
}

TEST_F(Help, TellsDefaultsAndLegalRanges) {
  const std::string text =
      std::regex_replace(run({"bake", "--help-all"}).out, std::regex("\\s+"), " ");  // wherever lines break
  for (const char* part : {"--fps N", "[default 60; 1 to 1000]", "[default: 4, limp 3, with --get-up 12;",
                           "[default medicine-ball]", "[default chest]", "[default: found out]"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST_F(Help, LinesFitATerminal) {
  for (const char* command : {"bake", "batch", "inspect", "judge", "render", "diff"}) {
    const std::string text = run({command, "--help"}).out;
    std::size_t begin = 0, lines = 0;
    for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
      EXPECT_LE(end - begin, 120u) << text.substr(begin, end - begin);
      begin = end + 1;
      ++lines;
    }
    EXPECT_GT(lines, 5u);
  }
}

}  // namespace
}  // namespace ukemi
