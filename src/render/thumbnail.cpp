#include "render/studio.h"

namespace ukemi {
namespace {

constexpr double kFree = 0.06;  // of half the picture, at its edges

}  // namespace

Result<Picture> render_thumbnail(const Shot& shot, const ThumbnailOptions& options) {
  const auto studio = open_studio(shot, {}, options.width, options.height);
  if (!studio) return studio.error();
  const DrawnCharacter& figure = studio->figure;
  const int frame = halfway_frame(*shot.clip, studio->joints);

  FrameGeometry geometry = figure.geometry(frame);
  geometry.ghost = figure.ghost(0);
  Geometry arrow;
  if (!shot.impact_direction.isZero()) {
    add_blow_arrow(arrow, shot, frame);
    add_blow_arrow(geometry, shot, frame);
  }

  Camera camera;
  camera.aspect = static_cast<double>(options.width) / options.height;
  camera.world_from_camera = telling_side(figure, shot, studio->joints);
  Framing framing(camera, {kFree, kFree, kFree, kFree});
  Eigen::AlignedBox3d seen;
  for (const Geometry& part : {figure.body(frame), geometry.ghost, arrow})
    for (const Vertex& vertex : part.vertices) {
      framing.add(vertex.position.cast<double>());
      seen.extend(vertex.position.cast<double>());
    }
  StageView stage = stage_about(framing.fit(), seen);
  stage.theme = theme(options.theme);
  return studio->painter->draw(geometry, stage);
}

}  // namespace ukemi
