#include "cli/program.h"

#include <algorithm>

namespace ukemi {
namespace {

constexpr int kMustChange = 2;

class Render : public Program {
 protected:
  std::string succeed(const std::vector<std::string>& arguments) {
    const Ran result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out;
  }
};

TEST_F(Render, MakesSheetsMovingPicturesAndSequences) {
  succeed({"render", "mannequin", "--clip", "walk", "--cells", "8", "--theme", "dark", "--rom", "--trail",
           "-o", "sheet.png"});
  EXPECT_EQ(read("sheet.png").substr(1, 3), "PNG");
  succeed({"render", "mannequin", "--clip", "walk", "--size", "160x90", "--fps", "5", "-o", "walk.webp"});
  EXPECT_EQ(read("walk.webp").substr(8, 4), "WEBP");
  EXPECT_NE(read("walk.webp").find("ANIM"), std::string::npos);
  succeed({"render", "mannequin", "--clip", "#0", "--turntable", "1", "--fps", "3", "--size", "96x96",
           "--axes", "--shapes", "-o", "turn_##.png"});
  const std::vector<std::string> found = files();
  EXPECT_NE(std::find(found.begin(), found.end(), "turn_00.png"), found.end());
  EXPECT_NE(std::find(found.begin(), found.end(), "turn_02.png"), found.end());
}

TEST_F(Render, EveryOptionChangesThePicture) {
  const std::vector<std::string> plain = {"render", "mannequin", "--clip", "walk", "--cells", "2"};
  const auto picture = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = plain;
    arguments.insert(arguments.end(), more.begin(), more.end());
    arguments.insert(arguments.end(), {"-o", "a.png"});
    succeed(arguments);
    return read("a.png");
  };
  const std::string without = picture({});
  EXPECT_EQ(picture({}), without);
  for (const std::vector<std::string>& option : std::vector<std::vector<std::string>>{{"--theme", "dark"},
                                                                                      {"--view", "back"},
                                                                                      {"--size", "400x500"},
                                                                                      {"--shapes"},
                                                                                      {"--axes"},
                                                                                      {"--rom"},
                                                                                      {"--trail"},
                                                                                      {"--columns", "1"},
                                                                                      {"--height", "1.2"}})
    EXPECT_NE(picture(option), without) << option.front();
  EXPECT_NE(picture({"--rom"}), picture({"--rom", "--region", "box"}));
}

TEST_F(Render, AMovingPictureTakesTheClipsTimeAtItsSpeed) {
  /// Time of all frames of an animated WebP, seconds: each ANMF chunk holds its own as 24 bits of
  /// milliseconds.
  const auto duration_s = [this](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"render", "mannequin", "--clip", "walk",
                                          "--size", "64x64",     "-o",     "a.webp"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    succeed(arguments);
    const std::string bytes = read("a.webp");
    double sum = 0.0;
    for (auto at = bytes.find("ANMF"); at != bytes.npos; at = bytes.find("ANMF", at + 4))
      for (int i = 0; i < 3; ++i)
        sum += static_cast<unsigned char>(bytes[at + 20 + static_cast<std::size_t>(i)]) * (1 << (8 * i)) /
               1000.0;
    return sum;
  };
  const double normal = duration_s({"--fps", "10"});
  EXPECT_GT(normal, 0.5);
  EXPECT_NEAR(duration_s({"--fps", "10", "--speed", "0.5"}), 2.0 * normal, 0.21);
  EXPECT_NEAR(duration_s({"--fps", "20"}), normal, 0.11);
}

TEST_F(Render, PutsSeveralClipsIntoRows) {
  succeed(
      {"bake", "mannequin", "--duration", "0.3", "-o", "a.glb", "--preview", "a.webp", "--theme", "dark"});
  EXPECT_NE(read("a.webp").find("ANIM"), std::string::npos);
  const std::string said = succeed({"render", "a.glb", "mannequin", "--size", "thumbnail", "-o", "both.png"});
  EXPECT_NE(said.find("clip 'chest_front', 0.3"), std::string::npos) << said;
  EXPECT_EQ(files(), (std::vector<std::string>{"a.glb", "a.webp", "both.png"}));
}

TEST_F(Render, RefusesWhatItCannotDraw) {
  const auto refuse = [this](std::vector<std::string> arguments, const std::string& what) {
    arguments.insert(arguments.begin(), {"render"});
    expect_refused(arguments, kMustChange, what);
  };
  refuse({"-o", "a.png"}, "no file");
  refuse({"mannequin", "-o", "a.png", "--theme", "blue"}, "blue");
  refuse({"mannequin", "-o", "a.png", "--size", "huge"}, "huge");
  refuse({"mannequin", "-o", "a.png", "--size", "100x90"}, "100 x 90");
  refuse({"mannequin", "-o", "a.png", "--view", "below"}, "below");
  refuse({"mannequin", "-o", "a.png", "--turntable", "3"}, "moving pictures");
  refuse({"mannequin", "-o", "a.png", "--rom", "--region", "nowhere"}, "nowhere");
  refuse({"mannequin", "-o", "a.webp", "--cells", "3"}, "sheets");
  refuse({"mannequin", "mannequin", "-o", "a.webp"}, "one clip");
  refuse({"mannequin", "-o", "a.png", "--cells", "2.5"}, "2.5");
}

}  // namespace
}  // namespace ukemi
