#include "render/canvas.h"

#include <gtest/gtest.h>

#include "render/font.h"
#include "render/texture.h"

namespace ukemi {
namespace {

int changed_pixels(const Picture& a, const Picture& b) {
  int changed = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4)
    changed += !std::equal(a.rgba.begin() + i, a.rgba.begin() + i + 4, b.rgba.begin() + i);
  return changed;
}

TEST(Canvas, rounded_fill_covers_the_area_of_a_disc) {
  Picture picture = blank(100, 100, hex(0x000000));
  fill(picture, {10, 10, 80, 80}, 40.0, hex(0xFFFFFF));
  double sum = 0.0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) sum += picture.rgba[i] / 255.0;
  EXPECT_NEAR(sum, 3.14159265 * 40.0 * 40.0, 10.0);
}

TEST(Font, draws_text_within_its_width) {
  const auto font = Font::open(FontStyle::regular);
  ASSERT_TRUE(font) << font.error().message();
  const Picture empty = blank(200, 40, hex(0xFFFFFF));
  Picture picture = empty;
  const double end = font->draw(picture, 10.0, 28, "0.42 s", 16.0, hex(0x000000));
  EXPECT_NEAR(end, 10.0 + font->width("0.42 s", 16.0), 1e-9);
  EXPECT_GT(changed_pixels(picture, empty), 60);
  Picture right = empty;
  for (int y = 0; y < 40; ++y)
    for (int x = static_cast<int>(end) + 2; x < 200; ++x) blend(right, x, y, hex(0xFF0000), 1.0);
  for (int y = 0; y < 40; ++y)
    for (int x = static_cast<int>(end) + 2; x < 200; ++x)
      ASSERT_EQ(picture.rgba[(static_cast<std::size_t>(y) * 200 + x) * 4], 255) << x << ' ' << y;
}

TEST(Font, shortens_what_does_not_fit_at_whole_characters) {
  const auto font = Font::open(FontStyle::bold);
  ASSERT_TRUE(font);
  const std::string text = "Überschlag rückwärts über die Böschung";
  const std::string shorter = font->fitted(text, 20.0, 150.0);
  EXPECT_LE(font->width(shorter, 20.0), 150.0);
  EXPECT_TRUE(shorter.ends_with("…"));
  EXPECT_TRUE(text.starts_with(shorter.substr(0, shorter.size() - std::string("…").size())));
  EXPECT_EQ(font->fitted(text, 20.0, 5000.0), text);
}

TEST(Font, survives_malformed_text) {
  const auto font = Font::open(FontStyle::regular);
  ASSERT_TRUE(font);
  Picture picture = blank(100, 40, hex(0xFFFFFF));
  for (const char* text : {"\xff\xfe", "\xc3", "a\xe2\x82", "\xf0\x9f\x98"})
    EXPECT_GT(font->draw(picture, 0.0, 20, text, 16.0, hex(0)), 0.0);
  EXPECT_LE(font->width(font->fitted("\x80\x80\x80\x80\x80\x80\x80\x80", 16.0, 20.0), 16.0), 20.0);
}

TEST(Png, keeps_every_pixel) {
  Picture picture = blank(37, 11, hex(0x102030));
  for (int i = 0; i < 37; ++i) blend(picture, i, i % 11, hex(0xFFCC00 + i), 0.7);
  const auto png = encode_png(picture);
  ASSERT_TRUE(png);
  const Picture back = decode_image({"image/png", *png}, 4096);
  EXPECT_EQ(back.width, 37);
  EXPECT_EQ(back.rgba, picture.rgba);
  picture.rgba[3] = 77;
  const auto with_alpha = encode_png(picture);
  ASSERT_TRUE(with_alpha);
  EXPECT_EQ(decode_image({"image/png", *with_alpha}, 4096).rgba, picture.rgba);
}

TEST(Png, refuses_a_picture_whose_size_lies) {
  Picture picture = blank(4, 4, hex(0));
  picture.height = 5;
  EXPECT_FALSE(encode_png(picture));
  EXPECT_FALSE(encode_png({}));
}

TEST(Texture, is_halved_until_it_fits) {
  Picture picture = blank(64, 16, hex(0x808080));
  const auto png = encode_png(picture);
  ASSERT_TRUE(png);
  const Picture small = decode_image({"image/png", *png}, 20);
  EXPECT_EQ(small.width, 16);
  EXPECT_EQ(small.height, 4);
  EXPECT_EQ(small.rgba[0], 0x80);
}

TEST(Texture, that_is_no_image_is_empty) {
  EXPECT_TRUE(decode_image({"image/png", {1, 2, 3, 4}}, 64).rgba.empty());
  EXPECT_TRUE(decode_image({"image/png", {}}, 64).rgba.empty());
}

}  // namespace
}  // namespace ukemi
