#include "render/texture.h"

#include <webp/decode.h>

#include <climits>
#include <memory>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS 16384
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace ukemi {
namespace {

/// Mean of 2 x 2 pixels, in sRGB: fine for small pictures of a texture.
Picture halved(const Picture& picture) {
  Picture half{std::max(1, picture.width / 2), std::max(1, picture.height / 2), {}};
  half.rgba.resize(std::size_t{4} * half.width * half.height);
  const auto pixel = [&](int x, int y, int channel) {
    const int column = std::min(x, picture.width - 1);
    const int row = std::min(y, picture.height - 1);
    return picture.rgba[(static_cast<std::size_t>(row) * picture.width + column) * 4 + channel];
  };
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x)
      for (int channel = 0; channel < 4; ++channel) {
        const int sum = pixel(2 * x, 2 * y, channel) + pixel(2 * x + 1, 2 * y, channel) +
                        pixel(2 * x, 2 * y + 1, channel) + pixel(2 * x + 1, 2 * y + 1, channel);
        half.rgba[(static_cast<std::size_t>(y) * half.width + x) * 4 + channel] =
            static_cast<std::uint8_t>((sum + 2) / 4);
      }
  return half;
}

using Pixels = std::unique_ptr<std::uint8_t, void (*)(void*)>;

bool is_webp(const Image& image) {
  return WebPGetInfo(image.bytes.data(), image.bytes.size(), nullptr, nullptr) != 0;
}

Pixels decode_webp(const Image& image, Picture& size) {
  return {WebPDecodeRGBA(image.bytes.data(), image.bytes.size(), &size.width, &size.height), WebPFree};
}

/// PNG, JPEG and what else stb_image reads.
Pixels decode_others(const Image& image, Picture& size) {
  int channels = 0;
  return {stbi_load_from_memory(image.bytes.data(), static_cast<int>(image.bytes.size()), &size.width,
                                &size.height, &channels, 4),
          stbi_image_free};
}

}  // namespace

Picture decode_image(const Image& image, int longest_side) {
  if (image.bytes.empty() || image.bytes.size() > INT_MAX) return {};
  Picture picture;
  const Pixels pixels = is_webp(image) ? decode_webp(image, picture) : decode_others(image, picture);
  if (!pixels) return {};
  picture.rgba.assign(pixels.get(), pixels.get() + std::size_t{4} * picture.width * picture.height);
  while (std::max(picture.width, picture.height) > longest_side) picture = halved(picture);
  return picture;
}

}  // namespace ukemi
