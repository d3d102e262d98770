#include "render/offscreen.h"

#include <GL/glcorearb.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <utility>

#include "render/gl.h"
#include "render/painter.h"

namespace ukemi {
namespace {

TEST(Offscreen, has_a_context) {
  const auto context = make_offscreen();
  ASSERT_TRUE(context) << context.error().message();
  GLint major = 0;
  Gl gl;
  ASSERT_TRUE(gl.load(**context));
  gl.GetIntegerv(GL_MAJOR_VERSION, &major);
  EXPECT_GE(major, 3);
}

TEST(Offscreen, contexts_follow_each_other) {
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(make_offscreen());
}

TEST(Offscreen, egl_draws_what_osmesa_draws) {
  FrameGeometry frame;
  frame.solid.begin({});
  add_ball(frame.solid, {}, 0.5, srgb(0xE07A3F), srgb(0x7A3B1D));
  StageView stage;
  stage.camera.eye = {0.0, 0.0, 3.0};
  stage.floor_y = -0.5;
  std::string reason;
  if (make_egl(reason) == nullptr) GTEST_SKIP() << "left out: " << reason;
  std::vector<Picture> pictures;
  for (const OffscreenKind kind : {OffscreenKind::osmesa, OffscreenKind::egl}) {
    const auto painter = Painter::make(64, 64, {}, kind);
    ASSERT_TRUE(painter) << painter.error().message();
    pictures.push_back((*painter)->draw(frame, stage));
  }
  int differing = 0;
  for (std::size_t i = 0; i < pictures[0].rgba.size(); ++i)
    differing += std::abs(pictures[0].rgba[i] - pictures[1].rgba[i]) > 8;
  EXPECT_LT(differing, 40);
}

/// UKEMI_OFFSCREEN for as long as this lives.
class Surroundings {
 public:
  explicit Surroundings(const char* value) {
    if (const char* before = std::getenv("UKEMI_OFFSCREEN")) before_ = before;
    setenv("UKEMI_OFFSCREEN", value, 1);
  }
  ~Surroundings() {
    before_.empty() ? unsetenv("UKEMI_OFFSCREEN") : setenv("UKEMI_OFFSCREEN", before_.c_str(), 1);
  }

 private:
  std::string before_;
};

TEST(Offscreen, is_of_the_kind_that_the_environment_names) {
  for (const auto& [word, kind] : {std::pair("egl", OffscreenKind::egl), {"osmesa", OffscreenKind::osmesa}}) {
    const Surroundings surroundings(word);
    const auto context = make_offscreen();
    ASSERT_TRUE(context) << context.error().message();
    EXPECT_EQ((*context)->kind(), kind) << word;
  }
  const Surroundings surroundings("glx");
  const auto context = make_offscreen();
  ASSERT_FALSE(context);
  EXPECT_EQ(context.error().what, "UKEMI_OFFSCREEN is 'glx'");
}

}  // namespace
}  // namespace ukemi
