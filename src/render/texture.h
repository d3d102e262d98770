// Encoded images to 8-bit RGBA.
#pragma once

#include "base/character.h"
#include "render/render.h"

namespace ukemi {

/// Decoded and, where a side is longer than `longest_side`, halved until it is not. PNG, JPEG, WebP and the
/// other formats of stb_image. An image that cannot be decoded gives an empty picture: the part is drawn
/// without it.
Picture decode_image(const Image& image, int longest_side);

}  // namespace ukemi
