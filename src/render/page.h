// What every drawn page shares: colours, fonts, the character's textures.
#pragma once

#include <vector>

#include "render/canvas.h"
#include "render/font.h"
#include "render/render.h"

namespace ukemi {

inline constexpr Color kPage = hex(0xFBF9F6);
inline constexpr Color kCellBorder = hex(0xDDD5C9);
inline constexpr Color kInk = hex(0x2E2A26);
inline constexpr Color kSoftInk = hex(0x7D746A);
inline constexpr Color kAccent = hex(0xC23B22);
inline constexpr Color kTag = hex(0x7D746A);
inline constexpr Color kPaper = hex(0xFFFFFF);

struct Fonts {
  Font regular, bold;
};

/// Errors: output, when a font file is missing.
Result<Fonts> open_fonts();

/// Images of a character by their index, halved until no side is longer; only those that a visible part shows
/// are decoded.
std::vector<Picture> decode_textures(const Character& character, int longest_side = 1024);

}  // namespace ukemi
