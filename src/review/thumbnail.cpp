#include "review/thumbnail.h"

#include <optional>
#include <utility>

#include "body/body.h"
#include "clip/start.h"

namespace ukemi {
namespace {

constexpr int kWidth = 320;  // more than a small card's, for screens with fine pixels
constexpr int kHeight = 240;
constexpr double kQuality = 80.0;

/// What is drawn where a character has no mesh.
struct Shapes {
  std::vector<BodyPose> segments;
  std::optional<ArticulatedBody> body;
};

Result<Shapes> shapes_of(const Character& character, const Humanoid& humanoid, const Clip& clip) {
  Shapes shapes;
  for (const Pose& pose : clip.frames)
    shapes.segments.push_back(canonical_segments_of(character.skeleton, humanoid, pose));
  Diagnostics quiet;
  auto body =
      build_body(character, humanoid, clip.frames.front(), shapes.segments.front(), BodyOptions{}, quiet);
  if (!body) return body.error();
  shapes.body = std::move(*body);
  return shapes;
}

}  // namespace

Result<ReviewThumbnails> review_thumbnails(const ReviewedClip& reviewed) {
  const auto& [character, humanoid, given, floor_m, point, direction] = reviewed;
  const Vec3 down(0.0, -floor_m, 0.0);
  Clip clip = given;
  for (Pose& frame : clip.frames) frame = moved(character.skeleton, humanoid, frame, down);
  Shot shot;
  shot.character = &character;
  shot.humanoid = &humanoid;
  shot.clip = &clip;
  shot.impact_point = point + down;
  shot.impact_direction = direction;
  std::optional<Shapes> shapes;
  if (character.parts.empty()) {
    auto made = shapes_of(character, humanoid, clip);
    if (!made) return made.error();
    shapes = std::move(*made);
    shot.body = &*shapes->body;
    shot.segments = &shapes->segments;
  }
  const auto pictures = render_thumbnails(shot, kWidth, kHeight);
  if (!pictures) return pictures.error();
  auto light = encode_webp(pictures->light, kQuality, Effort::quick);
  if (!light) return light.error();
  auto dark = encode_webp(pictures->dark, kQuality, Effort::quick);
  if (!dark) return dark.error();
  return ReviewThumbnails{std::move(*light), std::move(*dark)};
}

}  // namespace ukemi
