#include "render/moving.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "render/sheet_page.h"
#include "render/studio.h"

namespace ukemi {
namespace {

constexpr double kQuality = 80.0;
constexpr int kMostFrames = 3600;
constexpr int kMomentsInView = 12;   // frames whose whole skin the camera holds
constexpr double kTagTime_s = 0.25;  // a phase is named from its frame on

/// Which frame of the clip each picture shows, and how far round the camera is, radians.
struct Take {
  int frame = 0;
  double turn = 0.0;
};

std::vector<Take> takes_of(const Clip& clip, const MovingOptions& options) {
  const bool still = clip.frames.size() < 2;
  const double duration = still ? options.turn_s.value_or(0.0) : clip.duration_s() / options.speed;
  const int last = static_cast<int>(clip.frames.size()) - 1;
  const auto count = static_cast<int>(std::floor(duration * options.fps + 1e-6)) + (still ? 0 : 1);
  std::vector<Take> takes;
  for (int i = 0; i < std::min(count, kMostFrames + 1); ++i) {
    const double time = i / options.fps;
    const auto frame = static_cast<int>(std::lround(time * options.speed * clip.fps));
    takes.push_back({std::min(frame, last), options.turn_s ? 2.0 * kPi * time / *options.turn_s : 0.0});
  }
  return takes;
}

Status check(const Shot& shot, const MovingOptions& options) {
  if (std::min(options.width, options.height) < 64 || std::max(options.width, options.height) > 4096)
    return usage_error(
        fmt::format("moving pictures of {} x {} pixels cannot be drawn", options.width, options.height),
        "ask for sides of 64 to 4096 pixels");
  if (!(options.fps > 0.0) || !(options.speed > 0.0) || (options.turn_s && !(*options.turn_s > 0.0)))
    return usage_error("rate, speed and turn must be above 0", "give positive numbers");
  if (shot.clip->frames.size() < 2 && !options.turn_s)
    return usage_error(fmt::format("the clip '{}' is a single frame: nothing moves", shot.clip->name),
                       "add --turntable 4, or ask for a .png");
  if (takes_of(*shot.clip, options).size() > kMostFrames)
    return usage_error(fmt::format("more than {} pictures", kMostFrames), "ask for a lower --fps");
  return Done{};
}

/// The camera carried round the vertical through the stage's focus.
StageView turned(StageView stage, double angle) {
  if (angle == 0.0) return stage;
  const Quat turn(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  stage.camera.eye = stage.focus + turn * (stage.camera.eye - stage.focus);
  stage.camera.world_from_camera = turn * stage.camera.world_from_camera;
  return stage;
}

/// The phase that began last, not long ago.
std::string phase_at(const Clip& clip, double time_s) {
  std::string phase;
  for (const Mark& mark : clip.marks) {
    if (mark.name == "start" || time_s < mark.time_s || time_s > mark.time_s + kTagTime_s) continue;
    phase = mark.name;
  }
  std::replace(phase.begin(), phase.end(), '_', ' ');
  return phase;
}

/// How much of the clip is over, along the lower edge.
void draw_progress(Picture& picture, const Pen& pen, double share) {
  const int height = std::max(2, pen.scaled(3));
  const int y = picture.height - height;
  fill(picture, {0, y, picture.width, height}, 0.0, pen.theme.border);
  fill(picture, {0, y, static_cast<int>(std::lround(share * picture.width)), height}, 0.0, pen.theme.accent);
}

}  // namespace

Status render_moving(const Shot& shot, const MovingOptions& options,
                     const std::function<Status(const Picture&)>& take) {
  auto studio = study(shot, options.overlays);
  if (!studio) return studio.error();
  if (const Status status = check(shot, options); !status) return status;
  const auto fonts = open_fonts();
  if (!fonts) return fonts.error();
  if (const Status status = equip(*studio, options.width, options.height); !status) return status;

  const Clip& clip = *shot.clip;
  const Pen pen{*fonts, theme(options.theme), std::clamp(options.height / 360.0, 0.5, 4.0)};
  const std::vector<Moment> moments = choose_moments(clip, studio->joints, kMomentsInView);
  const Staging staging = set_stage(
      studio->figure, shot, studio->joints, moments, static_cast<double>(options.width) / options.height,
      0.04, {.view = options.view, .all_around = options.turn_s.has_value(), .theme = options.theme});
  for (const Take& t : takes_of(clip, options)) {
    const double time = t.frame / clip.fps;
    Picture picture = studio->painter->draw(studio->geometry(t.frame), turned(staging.at(t.frame), t.turn));
    if (clip.frames.size() > 1) {
      draw_label(picture, pen, {0, 0, picture.width, picture.height}, fmt::format("{:.2f} s", time),
                 phase_at(clip, time));
      draw_progress(picture, pen, time / clip.duration_s());
    }
    if (const Status status = take(picture); !status) return status;
  }
  return Done{};
}

Result<std::vector<std::uint8_t>> render_webp(const Shot& shot, const MovingOptions& options) {
  AnimationEncoder encoder(options.width, options.height, options.fps, kQuality);
  const Status drawn =
      render_moving(shot, options, [&](const Picture& picture) { return encoder.add(picture); });
  if (!drawn) return drawn.error();
  return encoder.finish();
}

}  // namespace ukemi
