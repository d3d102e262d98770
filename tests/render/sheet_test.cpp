#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <limits>

#include "base/files.h"
#include "render/boxy.h"
#include "render/staging.h"
#include "render/texture.h"

namespace ukemi {
namespace {

struct Scene {
  Character character = boxy_character();
  Clip clip = boxy_fall(character, 46);
  std::vector<Prop> props = boxy_ball(clip);
  Shot shot;
  SheetOptions small{.columns = 3, .cells = 6, .cell_width = 160, .cell_height = 180};

  Scene() {
    shot.character = &character;
    shot.clip = &clip;
    shot.props = &props;
    shot.impact_point = {0.0, 1.30, 0.11};
    shot.impact_direction = {0.0, 0.0, -1.0};
    shot.title = "boxy, hit on the chest from the front";
    shot.notes = {"medicine ball, 5 kg at 6 m/s"};
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  Picture draw() const {
    const auto sheet = render_sheet(shot, small);
    EXPECT_TRUE(sheet) << sheet.error().message();
    return sheet ? *sheet : Picture{};
  }
};

void save(const std::string& path, const Picture& picture) {
  const auto png = encode_png(picture);
  ASSERT_TRUE(png);
  const Status written = write_file(path, *png);
  ASSERT_TRUE(written) << written.error().message();
}

/// Pixels of which a channel differs by more than `tolerance`; `difference` shows them in red.
int differing(const Picture& a, const Picture& b, int tolerance, Picture& difference) {
  difference = a;
  int count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    int most = 0;
    for (int channel = 0; channel < 3; ++channel)
      most = std::max(most, std::abs(a.rgba[i + channel] - b.rgba[i + channel]));
    const bool differs = most > tolerance;
    count += differs;
    difference.rgba[i] = static_cast<std::uint8_t>(differs ? 255 : a.rgba[i] / 2 + 127);
    for (const int channel : {1, 2})
      difference.rgba[i + channel] = static_cast<std::uint8_t>(differs ? 0 : a.rgba[i + channel] / 2 + 127);
  }
  return count;
}

TEST(Sheet, looks_like_the_golden_picture) {
  const std::string golden_path = std::string(UKEMI_GOLDEN) + "/boxy_sheet.png";
  const Picture sheet = Scene().draw();
  if (std::getenv("UKEMI_UPDATE_GOLDEN") != nullptr) save(golden_path, sheet);
  const auto bytes = read_file(golden_path, 10'000'000);
  ASSERT_TRUE(bytes) << bytes.error().message();
  const Picture golden = decode_image({"image/png", *bytes}, 10000);
  ASSERT_EQ(sheet.width, golden.width);
  ASSERT_EQ(sheet.height, golden.height);
  Picture difference;
  const int count = differing(sheet, golden, 12, difference);
  const int allowed = sheet.width * sheet.height / 500;
  if (count > allowed) {
    save("boxy_sheet_now.png", sheet);
    save("boxy_sheet_difference.png", difference);
  }
  EXPECT_LE(count, allowed) << "see " << std::filesystem::current_path() / "boxy_sheet_difference.png"
                            << "; UKEMI_UPDATE_GOLDEN=1 accepts the new picture";
}

TEST(Sheet, is_the_same_twice) {
  const Scene scene;
  EXPECT_EQ(scene.draw().rgba, scene.draw().rgba);
}

TEST(Sheet, has_the_size_of_its_cells) {
  Scene scene;
  const Picture sheet = scene.draw();
  EXPECT_GT(sheet.width, 3 * 160);
  EXPECT_LT(sheet.width, 3 * 160 + 160);
  EXPECT_GT(sheet.height, 2 * 180);
  scene.clip.frames.resize(2);
  scene.clip.marks.clear();
  EXPECT_LT(scene.draw().width, sheet.width) << "two frames fill two columns";
}

TEST(Sheet, says_title_notes_time_and_phase) {
  Scene scene;
  const Picture sheet = scene.draw();
  Picture difference;
  const auto changed = [&] { return differing(sheet, scene.draw(), 40, difference); };
  EXPECT_EQ(changed(), 0);
  scene.shot.title = "boxy, hit on the chest from the back";
  EXPECT_GT(changed(), 50);
  scene.shot.title = "boxy, hit on the chest from the front";
  scene.shot.notes[0] = "medicine ball, 5 kg at 9 m/s";
  EXPECT_GT(changed(), 3);
  scene.shot.notes[0] = "medicine ball, 5 kg at 6 m/s";
  scene.clip.marks[1].name = "contact";
  scene.shot.impact_direction.setZero();
  Picture other = scene.draw();
  scene.clip.marks[1].name = "touching";
  EXPECT_GT(differing(other, scene.draw(), 40, difference), 20);
}

TEST(Sheet, camera_holds_all_joints_of_all_frames) {
  const Scene scene;
  const Figure figure(scene.shot, false);
  JointPaths joints;
  for (int frame = 0; frame < 46; ++frame) joints.push_back(figure.joints(frame));
  for (const double aspect : {0.5, 0.9, 2.0}) {
    const Staging staging =
        set_stage(figure, scene.shot, joints, choose_moments(scene.clip, joints, 12), aspect, 0.1);
    EXPECT_FALSE(staging.follows());
    double widest = 0.0;
    for (int frame = 0; frame < 46; ++frame)
      for (const Vec3& joint : joints[frame]) {
        const Vec3 p = staging.at(frame).camera.project(joint);
        ASSERT_GT(p.z(), 0.0);
        widest = std::max({widest, std::abs(p.x()), std::abs(p.y())});
      }
    EXPECT_LT(widest, 0.95);
    EXPECT_GT(widest, 0.6) << "the figure fills the cell";
  }
}

TEST(Sheet, camera_follows_a_figure_that_goes_far) {
  Scene scene;
  scene.shot.impact_direction.setZero();
  for (std::size_t frame = 0; frame < scene.clip.frames.size(); ++frame)
    scene.clip.frames[frame][0].translation.x() += 0.3 * static_cast<double>(frame);
  const Figure figure(scene.shot, false);
  JointPaths joints;
  for (int frame = 0; frame < 46; ++frame) joints.push_back(figure.joints(frame));
  const Staging staging =
      set_stage(figure, scene.shot, joints, choose_moments(scene.clip, joints, 12), 0.9, 0.1);
  EXPECT_TRUE(staging.follows());
  double tallest = 0.0;
  for (int frame = 0; frame < 46; ++frame) {
    const Camera camera = staging.at(frame).camera;
    double low = 1.0;
    double high = -1.0;
    for (const Vec3& joint : joints[frame]) {
      const Vec3 p = camera.project(joint);
      ASSERT_LT(std::max(std::abs(p.x()), std::abs(p.y())), 0.95);
      low = std::min(low, p.y());
      high = std::max(high, p.y());
    }
    tallest = std::max(tallest, high - low);
  }
  EXPECT_GT(tallest, 0.8) << "of 2: the standing figure is large";
}

TEST(Sheet, is_seen_across_the_blow_running_from_left_to_right) {
  Scene scene;
  const Figure figure(scene.shot, false);
  const JointPaths joints{figure.joints(0)};
  for (const Vec3& blow : {Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(-0.6, 0.0, 0.8)}) {
    scene.shot.impact_direction = blow;
    const Camera camera = set_stage(figure, scene.shot, joints, {{0, ""}}, 1.0, 0.1).stage.camera;
    EXPECT_GT(blow.dot(camera.world_from_camera * Vec3::UnitX()), 0.99);
  }
}

TEST(Sheet, shows_the_front_of_the_figure) {
  Scene scene;
  Humanoid humanoid;
  humanoid.segments[index(Segment::pelvis)].chain = {0};
  // The boxy figure looks along +z; segments have x in front.
  humanoid.node_from_segment[index(Segment::pelvis)] = Quat(Eigen::AngleAxisd(-0.5 * kPi, Vec3::UnitY()));
  scene.shot.humanoid = &humanoid;
  const Figure figure(scene.shot, false);
  EXPECT_LT((figure.facing(0) - Vec3::UnitZ()).norm(), 1e-12);
  for (const Vec3& blow : {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0)}) {
    scene.shot.impact_direction = blow;
    const Camera camera = set_stage(figure, scene.shot, {figure.joints(0)}, {{0, ""}}, 1.0, 0.1).stage.camera;
    const Vec3 to_camera = camera.world_from_camera * Vec3::UnitZ();
    EXPECT_GT(to_camera.z(), 0.4) << "blow " << blow.transpose();
    EXPECT_LT(std::abs(to_camera.dot(blow)), 0.6) << "not along the blow " << blow.transpose();
  }
}

TEST(Sheet, of_an_empty_clip_is_an_error) {
  Scene scene;
  scene.clip.frames.clear();
  const auto sheet = render_sheet(scene.shot, {});
  ASSERT_FALSE(sheet);
  EXPECT_EQ(sheet.error().kind, ErrorKind::input);
  EXPECT_NE(sheet.error().message().find("no frames"), std::string::npos);
}

TEST(Sheet, of_another_skeletons_clip_is_an_error) {
  Scene scene;
  scene.clip.frames[3].pop_back();
  ASSERT_FALSE(render_sheet(scene.shot, {}));
}

TEST(Sheet, of_a_joint_that_is_nowhere_is_an_error) {
  Scene scene;
  scene.clip.frames[3][0].translation.x() = std::numeric_limits<double>::quiet_NaN();
  const auto sheet = render_sheet(scene.shot, {});
  ASSERT_FALSE(sheet);
  EXPECT_NE(sheet.error().message().find("frame 3"), std::string::npos);
}

TEST(Sheet, of_impossible_cells_is_a_usage_error) {
  const Scene scene;
  for (const SheetOptions& options :
       {SheetOptions{.columns = 0}, SheetOptions{.cells = 0}, SheetOptions{.cell_width = 3},
        SheetOptions{.cell_height = 100000}, SheetOptions{.columns = 40, .cells = 40, .cell_width = 4096}}) {
    const auto sheet = render_sheet(scene.shot, options);
    ASSERT_FALSE(sheet);
    EXPECT_EQ(sheet.error().kind, ErrorKind::usage);
  }
}

}  // namespace
}  // namespace ukemi
