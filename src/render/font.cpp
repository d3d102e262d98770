#include "render/font.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <array>
#include <cmath>
#include <filesystem>

#include "base/errors.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;

constexpr std::array kFolders{"/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu-sans-fonts",
                              "/usr/share/fonts/TTF", "/usr/local/share/fonts"};

fs::path find_font(const char* file) {
  std::error_code error;
  for (const char* folder : kFolders)
    if (fs::exists(fs::path(folder) / file, error)) return fs::path(folder) / file;
  return {};
}

/// Next code point of UTF-8 text; malformed bytes give U+FFFD one by one.
char32_t next_code_point(std::string_view& text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t length = lead < 0x80 ? 1 : lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc2 ? 2 : 0;
  char32_t code = length == 1 ? lead : lead & (0x7fu >> length);
  bool good = length != 0 && length <= text.size() && lead < 0xf5;
  for (std::size_t i = 1; good && i < length; ++i) {
    const auto next = static_cast<unsigned char>(text[i]);
    good = (next & 0xc0) == 0x80;
    code = (code << 6) | (next & 0x3f);
  }
  text.remove_prefix(good ? length : 1);
  return good ? code : U'\ufffd';
}

}  // namespace

struct Font::Face {
  FT_Library library = nullptr;
  FT_Face face = nullptr;

  Face() = default;
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;
  ~Face() {
    if (face != nullptr) FT_Done_Face(face);
    if (library != nullptr) FT_Done_FreeType(library);
  }

  /// Calls visit(glyph slot, x of the pen) for each glyph; returns the pen's end.
  template <typename Visit>
  double each_glyph(std::string_view text, double size, FT_Int32 flags, Visit&& visit) const {
    FT_Set_Char_Size(face, 0, std::lround(size * 64.0), 72, 72);
    double pen = 0.0;
    FT_UInt previous = 0;
    while (!text.empty()) {
      const FT_UInt glyph = FT_Get_Char_Index(face, next_code_point(text));
      FT_Vector kern{0, 0};
      if (previous != 0) FT_Get_Kerning(face, previous, glyph, FT_KERNING_UNFITTED, &kern);
      pen += static_cast<double>(kern.x) / 64.0;
      previous = glyph;
      if (FT_Load_Glyph(face, glyph, flags) != 0) continue;
      visit(face->glyph, pen);
      pen += static_cast<double>(face->glyph->linearHoriAdvance) / 65536.0;
    }
    return pen;
  }
};

Font::Font(std::unique_ptr<Face> face) : face_(std::move(face)) {}
Font::Font(Font&&) noexcept = default;
Font& Font::operator=(Font&&) noexcept = default;
Font::~Font() = default;

Result<Font> Font::open(FontStyle style) {
  const char* file = style == FontStyle::bold ? "DejaVuSans-Bold.ttf" : "DejaVuSans.ttf";
  const fs::path path = find_font(file);
  auto face = std::make_unique<Face>();
  if (path.empty() || FT_Init_FreeType(&face->library) != 0 ||
      FT_New_Face(face->library, path.c_str(), 0, &face->face) != 0)
    return output_error(file, "the font of the labels is missing in " + std::string(kFolders[0]),
                        "install fonts-dejavu-core, or leave the picture out");
  return Font(std::move(face));
}

double Font::width(std::string_view text, double size) const {
  return face_->each_glyph(text, size, FT_LOAD_TARGET_LIGHT, [](FT_GlyphSlot, double) {});
}

double Font::draw(Picture& picture, double x, int baseline, std::string_view text, double size,
                  Color color) const {
  const double end = face_->each_glyph(
      text, size, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT, [&](FT_GlyphSlot slot, double pen) {
        const int left = static_cast<int>(std::lround(x + pen)) + slot->bitmap_left;
        const int top = baseline - slot->bitmap_top;
        for (int row = 0; row < static_cast<int>(slot->bitmap.rows); ++row)
          for (int column = 0; column < static_cast<int>(slot->bitmap.width); ++column) {
            const unsigned char coverage = slot->bitmap.buffer[row * slot->bitmap.pitch + column];
            blend(picture, left + column, top + row, color, coverage / 255.0);
          }
      });
  return x + end;
}

std::string Font::fitted(std::string_view text, double size, double width_limit) const {
  if (width(text, size) <= width_limit) return std::string(text);
  std::string shorter(text);
  while (!shorter.empty()) {
    while (!shorter.empty() && (static_cast<unsigned char>(shorter.back()) & 0xc0) == 0x80)
      shorter.pop_back();
    if (!shorter.empty()) shorter.pop_back();
    if (width(shorter + "…", size) <= width_limit) return shorter + "…";
  }
  return shorter;
}

}  // namespace ukemi
