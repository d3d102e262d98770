#include "bake/sheet.h"

#include <fmt/format.h>

#include "bake/impact.h"
#include "load/load.h"

namespace ukemi {
namespace {

constexpr double kThumbnailQuality = 82.0;
constexpr double kSheetRate = 60.0;  // clips of files are sampled at most this often

std::string blow_text(const BakeSettings& settings, const Scene& scene) {
  const std::string what = preset_in_use(settings).value_or(std::string(name(scene.kind)));
  switch (scene.kind) {
    case SceneKind::push:
      return fmt::format("{}: {:.0f} N for {:.2f} s", what, scene.push_force_n, scene.push_duration_s);
    case SceneKind::impulse:
      return fmt::format("{}: {:.1f} N s", what, scene.impulse_n_s);
    case SceneKind::fall:
      return fmt::format("fall: from {} m, tipped at {} m/s", scene.fall_height_m, scene.tip_speed_m_s);
    case SceneKind::slope:
      return fmt::format("{} down a ramp of {:.0f} degrees: {} kg at {} m/s", what, degrees(scene.slope_rad),
                         scene.ball_mass_kg, scene.ball_speed_m_s);
    case SceneKind::box:
      return fmt::format("box of {} m: {} kg at {} m/s", 2.0 * scene.ball_radius_m, scene.ball_mass_kg,
                         scene.ball_speed_m_s);
    case SceneKind::ball:
      break;
  }
  return fmt::format("{}: {} kg at {} m/s", what, scene.ball_mass_kg, scene.ball_speed_m_s);
}

std::vector<std::string> figure_lines(const BakeSettings& settings, const BakeOutcome& outcome) {
  const LimitFigures& limits = outcome.simulation.limits;
  const SimulationFigures& figures = outcome.simulation.figures;
  std::vector<std::string> lines = {
      blow_text(settings, outcome.scene),
      fmt::format("{:.2f} m, {:.1f} kg", outcome.humanoid.height_m, outcome.body.mass_kg),
      fmt::format("outside its range by more than 1 degree: {} of {} samples, at most {:.2f} degrees",
                  limits.over_1deg, limits.samples, limits.excess_max_deg)};
  if (figures.rest_time_s) lines.push_back(fmt::format("at rest after {:.2f} s", *figures.rest_time_s));
  return lines;
}

Result<std::vector<std::uint8_t>> sheet_png(const Shot& shot, bool shapes) {
  SheetOptions options;
  options.shapes = shapes;
  const auto picture = render_sheet(shot, options);
  if (!picture) return picture.error();
  return encode_png(*picture);
}

/// Moves a clip whose floor lies at another height to y = 0, where pictures have theirs.
void put_on_floor(const Character& character, const Humanoid& humanoid, double floor_m, Clip& clip) {
  if (floor_m == 0.0) return;
  for (Pose& frame : clip.frames)
    frame = moved(character.skeleton, humanoid, frame, Vec3(0.0, -floor_m, 0.0));
}

Result<Clip> clip_to_draw(const Character& character, const RenderSettings& settings) {
  if (!settings.clip && character.animations.empty()) {
    Clip still{"rest pose", kSheetRate, {}, {}};
    still.frames.push_back(rest_pose(character.skeleton));
    return still;
  }
  std::size_t chosen = character.animations.size() - 1;
  if (settings.clip) {
    const auto found = find_clip(character, *settings.clip);
    if (!found) return found.error();
    chosen = *found;
  }
  Clip clip = sample_clip(character.skeleton, character.animations[chosen], kSheetRate);
  clip.name = clip_label(character, chosen);
  return clip;
}

/// What is drawn beside the mesh, and where.
struct Shapes {
  Humanoid humanoid;
  std::optional<ArticulatedBody> body;
  std::vector<BodyPose> segments;
};

/// Puts the clip on the floor and finds the segments' shapes where they are wanted.
Result<Shapes> place(const Character& character, Clip& clip, const RenderSettings& settings,
                     Diagnostics& diagnostics) {
  auto humanoid = map_humanoid(character, settings.humanoid, diagnostics);
  if (!humanoid) return humanoid.error();
  Shapes shapes{std::move(*humanoid), std::nullopt, {}};
  put_on_floor(character, shapes.humanoid, floor_of(character, shapes.humanoid, clip.frames), clip);
  if (!settings.shapes && !character.parts.empty()) return shapes;
  for (const Pose& pose : clip.frames)
    shapes.segments.push_back(canonical_segments_of(character.skeleton, shapes.humanoid, pose));
  auto body = build_body(character, shapes.humanoid, clip.frames.front(), shapes.segments.front(),
                         BodyOptions{}, diagnostics);
  if (!body) return body.error();
  shapes.body = std::move(*body);
  return shapes;
}

Clip clip_on_floor(const Character& character, const BakeOutcome& outcome) {
  Clip clip = outcome.clip;
  put_on_floor(character, outcome.humanoid, outcome.start.floor_m, clip);
  return clip;
}

/// Contract: all four outlive the shot.
Shot shot_of(const Character& character, const BakeSettings& settings, const BakeOutcome& outcome,
             const Clip& clip) {
  const Trajectory& trajectory = outcome.simulation.trajectory;
  Shot shot;
  shot.character = &character;
  shot.humanoid = &outcome.humanoid;
  shot.clip = &clip;
  shot.body = &outcome.body;
  shot.segments = &trajectory.frames;
  shot.props = &trajectory.props;
  shot.impact_point = trajectory.impact_point;
  shot.impact_direction = trajectory.impact_direction;
  shot.title =
      outcome.scene.kind == SceneKind::fall
          ? fmt::format("{}: falls away from {}", character.name, settings.from)
          : fmt::format("{}: {} hit from {}", character.name, name(outcome.scene.target), settings.from);
  shot.notes = figure_lines(settings, outcome);
  return shot;
}

}  // namespace

Result<std::vector<std::uint8_t>> bake_sheet(const Character& character, const BakeSettings& settings,
                                             const BakeOutcome& outcome) {
  const Clip clip = clip_on_floor(character, outcome);
  return sheet_png(shot_of(character, settings, outcome, clip), false);
}

Result<std::vector<std::uint8_t>> bake_thumbnail(const Character& character, const BakeSettings& settings,
                                                 const BakeOutcome& outcome,
                                                 const ThumbnailOptions& options) {
  const Clip clip = clip_on_floor(character, outcome);
  const auto picture = render_thumbnail(shot_of(character, settings, outcome, clip), options);
  if (!picture) return picture.error();
  return encode_webp(*picture, kThumbnailQuality);
}

Result<RenderedClip> render_clip(const std::string& file, const RenderSettings& settings,
                                 Diagnostics& diagnostics) {
  const auto path = character_path(file);
  if (!path) return path.error();
  const auto character = load_character(*path, LoadOptions{}, diagnostics);
  if (!character) return character.error();
  auto clip = clip_to_draw(*character, settings);
  if (!clip) return clip.error();
  const auto shapes = place(*character, *clip, settings, diagnostics);
  if (!shapes) return shapes.error();
  Shot shot;
  shot.character = &*character;
  shot.humanoid = &shapes->humanoid;
  shot.clip = &*clip;
  if (shapes->body) {
    shot.body = &*shapes->body;
    shot.segments = &shapes->segments;
  }
  shot.title = fmt::format("{}: {}", character->name, clip->name);
  shot.notes = {fmt::format("{:.2f} s", clip->duration_s())};
  auto png = sheet_png(shot, settings.shapes);
  if (!png) return png.error();
  return RenderedClip{clip->name, clip->duration_s(), std::move(*png)};
}

}  // namespace ukemi
