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

struct Scene : BoxyScene {
  SheetOptions small{.columns = 3, .cells = 6, .cell_width = 160, .cell_height = 180};

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

TEST(Sheet, says_title_figures_time_and_phase) {
  Scene scene;
  const Picture sheet = scene.draw();
  Picture difference;
  const auto changed = [&] { return differing(sheet, scene.draw(), 40, difference); };
  EXPECT_EQ(changed(), 0);
  scene.shot.title = "boxy, hit on the chest from the back";
  EXPECT_GT(changed(), 50);
  scene.shot.title = "boxy, hit on the chest from the front";
  scene.shot.facts[0].value = "medicine ball, 5 kg at 9 m/s";
  EXPECT_GT(changed(), 3);
  scene.shot.facts[0].value = "medicine ball, 5 kg at 6 m/s";
  scene.clip.marks[1].name = "contact";
  scene.shot.impact_direction.setZero();
  Picture other = scene.draw();
  scene.clip.marks[1].name = "touching";
  EXPECT_GT(differing(other, scene.draw(), 40, difference), 20);
}

TEST(Sheet, camera_holds_all_joints_of_all_frames) {
  const Scene scene;
  const DrawnCharacter figure(scene.shot, {});
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
  const DrawnCharacter figure(scene.shot, {});
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
  const DrawnCharacter figure(scene.shot, {});
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
  const DrawnCharacter figure(scene.shot, {});
  EXPECT_LT((figure.facing(0) - Vec3::UnitZ()).norm(), 1e-12);
  for (const Vec3& blow : {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0)}) {
    scene.shot.impact_direction = blow;
    const Camera camera = set_stage(figure, scene.shot, {figure.joints(0)}, {{0, ""}}, 1.0, 0.1).stage.camera;
    const Vec3 to_camera = camera.world_from_camera * Vec3::UnitZ();
    EXPECT_GT(to_camera.z(), 0.4) << "blow " << blow.transpose();
    EXPECT_LT(std::abs(to_camera.dot(blow)), 0.6) << "not along the blow " << blow.transpose();
  }
}

TEST(Sheet, is_dark_in_the_dark_theme) {
  Scene scene;
  EXPECT_GT(scene.draw().rgba[0], 200);
  scene.small.theme = ThemeKind::dark;
  EXPECT_LT(scene.draw().rgba[0], 60);
}

TEST(Sheet, fills_the_page_that_is_asked_for) {
  Scene scene;
  for (const auto& [width, height] : {std::pair{480, 440}, {1000, 700}, {700, 1000}, {1600, 900}}) {
    const auto options = fit_sheet(scene.small, width, height);
    ASSERT_TRUE(options) << options.error().message();
    const auto sheet = render_sheet(scene.shot, *options);
    ASSERT_TRUE(sheet) << sheet.error().message();
    EXPECT_NEAR(sheet->width, width, 0.03 * width);
    EXPECT_NEAR(sheet->height, height, 0.12 * height) << width << " x " << height;
    EXPECT_LE(sheet->height, height + 3);
  }
  EXPECT_FALSE(fit_sheet(scene.small, 100, 700));
  EXPECT_FALSE(fit_sheet({.cells = 1000}, 480, 440));
}

TEST(Sheet, is_seen_from_where_it_is_asked_to) {
  Scene scene;
  const DrawnCharacter figure(scene.shot, {});
  const JointPaths joints{figure.joints(0)};
  for (const double azimuth : {0.0, 1.0, -2.0}) {
    const Viewpoint viewpoint{.view = ViewAngles{azimuth, 0.3}};
    const Camera camera = set_stage(figure, scene.shot, joints, {{0, ""}}, 1.0, 0.1, viewpoint).stage.camera;
    const Vec3 to_camera = camera.world_from_camera * Vec3::UnitZ();
    EXPECT_NEAR(std::atan2(to_camera.x(), to_camera.z()), azimuth, 1e-9);
    EXPECT_NEAR(std::asin(to_camera.y()), 0.3, 1e-9);
  }
}

TEST(Strips, have_a_row_for_each_clip_and_hold_the_one_that_ends_first) {
  const BoxyScene long_one;
  BoxyScene short_one;
  short_one.clip.frames.resize(20);
  StripsOptions options;
  options.sheet.cells = 4;
  options.sheet.cell_width = 120;
  options.sheet.cell_height = 130;
  const auto one = render_strips({long_one.shot}, options);
  const auto two = render_strips({long_one.shot, short_one.shot}, options);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->width, two->width);
  EXPECT_GT(two->height, one->height + 130);
  EXPECT_LT(two->height, one->height + 190);
}

TEST(Strips, fill_the_page_that_is_asked_for) {
  const BoxyScene scene;
  StripsOptions options;
  options.sheet.cells = 5;
  const auto sheet = fit_strips(options.sheet, 2, 900, 480);
  ASSERT_TRUE(sheet) << sheet.error().message();
  options.sheet = *sheet;
  const auto picture = render_strips({scene.shot, scene.shot}, options);
  ASSERT_TRUE(picture);
  EXPECT_NEAR(picture->width, 900, 20);
  EXPECT_NEAR(picture->height, 480, 20);
}

TEST(Strips, of_clips_of_different_rates_are_refused) {
  const BoxyScene scene;
  BoxyScene other;
  other.clip.fps = 60.0;
  EXPECT_FALSE(render_strips({scene.shot, other.shot}, {}));
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
