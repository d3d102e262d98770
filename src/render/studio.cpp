#include "render/studio.h"

#include <fmt/format.h>

#include <cmath>

#include "base/errors.h"
#include "render/page.h"

namespace ukemi {
namespace {

Status check(const Shot& shot) {
  if (shot.character == nullptr || shot.clip == nullptr)
    return internal_error("a shot without character or clip", "report this");
  if (shot.clip->frames.empty())
    return input_error(shot.character->path, fmt::format("the clip '{}' has no frames", shot.clip->name),
                       "choose another clip");
  if (!(shot.clip->fps > 0.0) || !std::isfinite(shot.clip->fps))
    return input_error(shot.character->path, fmt::format("the clip '{}' has no frame rate", shot.clip->name),
                       "choose another clip");
  for (const Pose& pose : shot.clip->frames)
    if (static_cast<int>(pose.size()) != shot.character->skeleton.size())
      return input_error(shot.character->path,
                         fmt::format("the clip '{}' is not of this character's skeleton", shot.clip->name),
                         "choose a clip of the same character");
  return Done{};
}

Status check_finite(const Shot& shot, const JointPaths& joints) {
  for (std::size_t frame = 0; frame < joints.size(); ++frame)
    for (const Vec3& joint : joints[frame])
      if (!joint.allFinite() || joint.norm() > 1e6)
        return input_error(shot.character->path,
                           fmt::format("frame {} of the clip '{}' has a joint whose position is not finite",
                                       frame, shot.clip->name),
                           "check the clip's values");
  return Done{};
}

}  // namespace

FrameGeometry Studio::geometry(int frame) const {
  FrameGeometry result = figure.geometry(frame);
  if (shows_arrow(shot, frame)) add_blow_arrow(result, shot, frame);
  return result;
}

Result<Studio> study(const Shot& shot, const Overlays& overlays) {
  if (const Status status = check(shot); !status) return status.error();
  Studio studio{shot, DrawnCharacter(shot, overlays), {}, nullptr};
  for (std::size_t frame = 0; frame < shot.clip->frames.size(); ++frame)
    studio.joints.push_back(studio.figure.joints(static_cast<int>(frame)));
  if (const Status status = check_finite(shot, studio.joints); !status) return status.error();
  return studio;
}

Status equip(Studio& studio, int width, int height) {
  auto painter = Painter::make(width, height, decode_textures(*studio.shot.character));
  if (!painter) return painter.error();
  studio.painter = std::move(*painter);
  return Done{};
}

Result<Studio> open_studio(const Shot& shot, const Overlays& overlays, int width, int height) {
  auto studio = study(shot, overlays);
  if (!studio) return studio;
  if (const Status status = equip(*studio, width, height); !status) return status.error();
  return studio;
}

}  // namespace ukemi
