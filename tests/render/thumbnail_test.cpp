#include <gtest/gtest.h>

#include "render/boxy.h"
#include "render/moving.h"
#include "render/render.h"
#include "render/texture.h"

namespace ukemi {
namespace {

std::uint32_t little_endian(const std::vector<std::uint8_t>& bytes, std::size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value |= static_cast<std::uint32_t>(bytes[at + i]) << (8 * i);
  return value;
}

TEST(Thumbnail, has_the_size_asked_for_and_shows_start_motion_and_blow) {
  BoxyScene scene;
  const auto whole = render_thumbnails(scene.shot, 160, 120);
  ASSERT_TRUE(whole) << whole.error().message();
  EXPECT_EQ(whole->light.width, 160);
  EXPECT_EQ(whole->light.height, 120);
  scene.shot.impact_direction.setZero();
  scene.clip.frames.resize(1);
  const auto still = render_thumbnails(scene.shot, 160, 120);
  ASSERT_TRUE(still);
  EXPECT_GT(differing_pixels(whole->light, still->light, 24), 300);
}

TEST(Thumbnail, is_dark_in_the_dark_theme) {
  const BoxyScene scene;
  const auto both = render_thumbnails(scene.shot, 96, 72);
  ASSERT_TRUE(both);
  EXPECT_GT(both->light.rgba[0], 200);
  EXPECT_LT(both->dark.rgba[0], 80);
}

TEST(WebP, of_a_picture_is_small_and_has_its_size) {
  const BoxyScene scene;
  const auto pictures = render_thumbnails(scene.shot, 160, 120);
  ASSERT_TRUE(pictures);
  const auto bytes = encode_webp(pictures->light, 80.0);
  ASSERT_TRUE(bytes) << bytes.error().message();
  EXPECT_EQ(std::string(bytes->begin(), bytes->begin() + 4), "RIFF");
  EXPECT_EQ(std::string(bytes->begin() + 8, bytes->begin() + 16), "WEBPVP8 ");
  EXPECT_EQ(little_endian(*bytes, 26, 2) & 0x3fff, 160u);
  EXPECT_EQ(little_endian(*bytes, 28, 2) & 0x3fff, 120u);
  EXPECT_LT(bytes->size(), 6000u);
}

/// Durations of an animation's frames, milliseconds.
std::vector<std::uint32_t> durations(const std::vector<std::uint8_t>& webp) {
  std::vector<std::uint32_t> found;
  for (std::size_t at = 12; at + 8 <= webp.size();) {
    const std::string kind(webp.begin() + at, webp.begin() + at + 4);
    if (kind == "ANMF") found.push_back(little_endian(webp, at + 8 + 12, 3));
    const std::uint32_t size = little_endian(webp, at + 4, 4);
    at += 8 + size + (size & 1);
  }
  return found;
}

TEST(WebP, animation_holds_every_frame_for_its_time) {
  AnimationEncoder encoder(32, 24, 30.0, 80.0);
  Picture picture{32, 24, std::vector<std::uint8_t>(std::size_t{4} * 32 * 24, 255)};
  for (int frame = 0; frame < 6; ++frame) {
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
      picture.rgba[i] = static_cast<std::uint8_t>(40 * frame);
    ASSERT_TRUE(encoder.add(picture));
  }
  const auto bytes = encoder.finish();
  ASSERT_TRUE(bytes) << bytes.error().message();
  EXPECT_EQ(durations(*bytes), (std::vector<std::uint32_t>{33, 34, 33, 33, 34, 33}));
}

TEST(WebP, is_read_as_a_texture) {
  Picture picture{16, 8, std::vector<std::uint8_t>(std::size_t{4} * 16 * 8, 255)};
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) picture.rgba[i] = 40;
  const auto bytes = encode_webp(picture, 100.0);
  ASSERT_TRUE(bytes);
  const Picture decoded = decode_image({"image/webp", *bytes}, 1024);
  ASSERT_EQ(decoded.width, 16);
  ASSERT_EQ(decoded.height, 8);
  EXPECT_LT(differing_pixels(decoded, picture, 8), 1);
  std::vector<std::uint8_t> cut(bytes->begin(), bytes->begin() + 40);
  EXPECT_TRUE(decode_image({"image/webp", cut}, 1024).rgba.empty());
}

TEST(WebP, animation_without_a_frame_is_an_error) {
  AnimationEncoder encoder(32, 24, 30.0, 80.0);
  EXPECT_FALSE(encoder.finish());
}

}  // namespace
}  // namespace ukemi
