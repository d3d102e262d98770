#include "bake/review_thumbnail.h"

#include <algorithm>

#include "bake/start.h"
#include "render/page.h"
#include "render/staging.h"

namespace ukemi {
namespace {

constexpr int kWidth = 360;
constexpr int kHeight = 300;
constexpr int kMoments = 4;  // of the clip, of which the third is shown

}  // namespace

Result<std::vector<std::uint8_t>> review_thumbnail(const Character& character, const Humanoid& humanoid,
                                                   const Clip& clip, const Vec3& direction, double floor_m) {
  Clip on_floor = clip;
  if (floor_m != 0.0)
    for (Pose& frame : on_floor.frames)
      frame = moved(character.skeleton, humanoid, frame, Vec3(0.0, -floor_m, 0.0));
  Shot shot;
  shot.character = &character;
  shot.humanoid = &humanoid;
  shot.clip = &on_floor;
  shot.impact_direction = direction;
  const Figure figure(shot, false);
  JointPaths joints;
  for (std::size_t frame = 0; frame < on_floor.frames.size(); ++frame)
    joints.push_back(figure.joints(static_cast<int>(frame)));
  const std::vector<Moment> moments = choose_moments(on_floor, joints, kMoments);
  const Moment& moment = moments[std::min<std::size_t>(2, moments.size() - 1)];
  auto painter = Painter::make(kWidth, kHeight, decode_textures(character));
  if (!painter) return painter.error();
  const Staging staging =
      set_stage(figure, shot, joints, moments, static_cast<double>(kWidth) / kHeight, 0.0);
  return encode_png((*painter)->draw(figure.geometry(moment.frame), staging.at(moment.frame)));
}

}  // namespace ukemi
