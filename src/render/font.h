// Text on pictures: FreeType and DejaVu Sans.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/result.h"
#include "render/canvas.h"

namespace ukemi {

enum class FontStyle { regular, bold };

/// One face; sizes are in pixels (em), text is UTF-8. Not for several threads at once.
class Font {
 public:
  /// Errors: output, when the font file is missing.
  static Result<Font> open(FontStyle style);
  Font(Font&&) noexcept;
  Font& operator=(Font&&) noexcept;
  ~Font();

  double width(std::string_view text, double size) const;
  /// Left end at x, baseline at y. Returns the pen's x after the text.
  double draw(Picture& picture, double x, int baseline, std::string_view text, double size,
              Color color) const;
  /// The text, or its beginning with an ellipsis, so that it is at most `width` wide.
  std::string fitted(std::string_view text, double size, double width) const;

 private:
  struct Face;
  explicit Font(std::unique_ptr<Face> face);
  std::unique_ptr<Face> face_;
};

}  // namespace ukemi
