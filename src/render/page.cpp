#include "render/page.h"

#include "render/texture.h"

namespace ukemi {
Result<Fonts> open_fonts() {
  auto regular = Font::open(FontStyle::regular);
  if (!regular) return regular.error();
  auto bold = Font::open(FontStyle::bold);
  if (!bold) return bold.error();
  return Fonts{std::move(*regular), std::move(*bold)};
}

std::vector<Picture> decode_textures(const Character& character, int longest_side) {
  std::vector<Picture> pictures(character.images.size());
  for (const MeshPart& part : character.parts) {
    if (part.indices.empty() || part.uvs.empty() || part.material < 0) continue;
    const int image = character.materials[part.material].base_color_image;
    if (image >= 0 && pictures[image].rgba.empty())
      pictures[image] = decode_image(character.images[image], longest_side);
  }
  return pictures;
}

}  // namespace ukemi
