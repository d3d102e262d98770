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
