#include <string>
#include <vector>

#include "base/digest.h"
#include "render/page.h"
#include "render/small_painter.h"
#include "render/studio.h"

namespace ukemi {
namespace {

constexpr double kFree = 0.06;  // of half the picture, at its edges
constexpr int kLongestTextureSide = 256;

/// The textures that a character's parts show. Many clips of one character are drawn one after another: the
/// last one's are kept, because decoding takes longer than drawing.
const std::vector<Picture>& textures_of(const Character& character) {
  thread_local std::string kept_digest;
  thread_local std::vector<Picture> kept;
  Digest digest;
  for (const Image& image : character.images) digest.add(image.bytes);
  for (const MeshPart& part : character.parts)
    digest.add_field(part.material < 0 || part.uvs.empty()
                         ? "-"
                         : std::to_string(character.materials[part.material].base_color_image));
  if (std::string now = digest.hex(); now != kept_digest) {
    kept = decode_textures(character, kLongestTextureSide);
    kept_digest = std::move(now);
  }
  return kept;
}

}  // namespace

Result<Thumbnails> render_thumbnails(const Shot& shot, int width, int height) {
  const auto studio = study(shot, {});
  if (!studio) return studio.error();
  const DrawnCharacter& figure = studio->figure;
  const int frame = halfway_frame(*shot.clip, studio->joints);

  FrameGeometry geometry = figure.geometry(frame);
  geometry.ghost = figure.ghost(0);
  Geometry arrow;
  if (!shot.impact_direction.isZero()) add_blow_arrow(arrow, shot, frame);

  Camera camera;
  camera.aspect = static_cast<double>(width) / height;
  camera.world_from_camera = telling_side(figure, shot, studio->joints);
  Framing framing(camera, {kFree, kFree, kFree, kFree});
  Eigen::AlignedBox3d seen;
  for (const Geometry* part : {&geometry.solid, &geometry.ghost, &arrow})
    for (const Vertex& vertex : part->vertices) {
      framing.add(vertex.position.cast<double>());
      seen.extend(vertex.position.cast<double>());
    }
  if (!shot.impact_direction.isZero()) add_blow_arrow(geometry, shot, frame);
  const SmallPainter painter(width, height, geometry, stage_about(framing.fit(), seen),
                             textures_of(*shot.character));
  return Thumbnails{painter.in(theme(ThemeKind::light)), painter.in(theme(ThemeKind::dark))};
}

}  // namespace ukemi
