#include "render/theme.h"

#include "render/page.h"

namespace ukemi {

const Theme& theme(ThemeKind kind) {
  static const Theme light{kPage,   hex(0xF1ECE4), kCellBorder,    kInk,           kSoftInk,
                           kAccent, kPaper,        srgb(0xF3EFE8), srgb(0xE9E3D9), srgb(0xB7AC9B, 0.75f)};
  static const Theme dark{hex(0x15171B), hex(0x1E2127), hex(0x343942),  hex(0xF0ECE5),  hex(0xA29C92),
                          hex(0xD9492C), kPaper,        srgb(0x262A31), srgb(0x31363F), srgb(0x6A7280, 0.7f)};
  return kind == ThemeKind::dark ? dark : light;
}

}  // namespace ukemi
