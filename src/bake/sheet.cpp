#include "bake/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>

#include "bake/response.h"
#include "base/character_path.h"
#include "base/errors.h"
#include "base/numbers.h"
#include "clip/frames.h"
#include "clip/names.h"
#include "clip/start.h"
#include "humanoid/rotations.h"
#include "load/load.h"
#include "prepare/impact.h"

namespace ukemi {
namespace {

constexpr double kThumbnailQuality = 82.0;
constexpr int kStripCells = 6, kStripCellWidth = 280, kStripCellHeight = 300;
constexpr double kLevelElevation = radians(14.0);  // of a view that gives only an azimuth
/// Paper: across, 300 pixels an inch.
constexpr std::pair<std::string_view, std::array<int, 2>> kPictureSizes[] = {
    {"thumbnail", {480, 440}}, {"screen", {1920, 1080}}, {"a4", {3508, 2480}}, {"a3", {4961, 3508}}};
constexpr double kSheetRate = 60.0;  // clips of files are sampled at most this often

std::string blow_text(const BakeSettings& settings, const Scene& scene) {
  const std::string what = preset_in_use(settings).value_or(std::string(name(scene.kind)));
  switch (scene.kind) {
    case SceneKind::push:
    case SceneKind::trip:
    case SceneKind::slip:
    case SceneKind::pull:
      return fmt::format("{}: {:.0f} N for {:.2f} s", what, scene.push_force_n, scene.push_duration_s);
    case SceneKind::impulse:
    case SceneKind::explosion:
      return fmt::format("{}: {:.1f} N s", what, scene.impulse_n_s);
    case SceneKind::fall:
      return fmt::format("fall: from {} m, tipped at {} m/s", scene.fall_height_m, scene.tip_speed_m_s);
    case SceneKind::slope:
      return fmt::format("{} down a ramp of {:.0f} degrees: {} kg at {} m/s", what, degrees(scene.slope_rad),
                         scene.ball_mass_kg, scene.ball_speed_m_s);
    case SceneKind::none:
      return "none";
    case SceneKind::box:
      return fmt::format("box of {} m: {} kg at {} m/s", 2.0 * scene.ball_radius_m, scene.ball_mass_kg,
                         scene.ball_speed_m_s);
    case SceneKind::ball:
      break;
  }
  return fmt::format("{}: {} kg at {} m/s", what, scene.ball_mass_kg, scene.ball_speed_m_s);
}

std::vector<Fact> facts_of(const BakeSettings& settings, const BakedClip& outcome) {
  const LimitFigures& limits = outcome.limits;
  const SimulationFigures& figures = outcome.figures;
  std::vector<Fact> facts = {
      {"blow", blow_text(settings, outcome.prepared.scene)},
      {"figure",
       fmt::format("{:.2f} m, {:.1f} kg", outcome.prepared.humanoid.height_m, outcome.prepared.body.mass_kg)},
      {outcome.prepared.widened.empty() ? "over 1° outside the range" : "over 1° outside the widened range",
       fmt::format("{} of {} samples", limits.over_1deg, limits.samples)},
      {"largest excess", fmt::format("{:.2f}°", limits.excess_max_deg)}};
  if (!outcome.prepared.widened.empty())
    facts.push_back({"outside the human range", fmt::format("up to {:.1f}°", outcome.human.excess_max_deg)});
  if (figures.first_ground_contact_s)
    facts.push_back({"first ground contact", fmt::format("{:.2f} s", *figures.first_ground_contact_s)});
  facts.push_back({"outcome", outcome_text(response_of(outcome))});
  facts.push_back(
      {"at rest", figures.rest_time_s ? fmt::format("{:.2f} s", *figures.rest_time_s) : "not yet"});
  return facts;
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
  clip.marks = marks_in_extras(character.animations[chosen].extras_json);
  return clip;
}

/// A file's clip, ready to be drawn. The shot points into it.
struct Loaded {
  Character character;
  Humanoid humanoid;
  Clip clip;
  std::optional<ArticulatedBody> body;
  std::vector<BodyPose> segments;
};

/// The segments of every frame, rolled as the bake that made the clip says, if one did.
std::vector<BodyPose> segments_in(const Loaded& loaded) {
  const Skeleton& skeleton = loaded.character.skeleton;
  std::optional<SegmentFrames> stored;
  for (const Animation& animation : loaded.character.animations)
    if (animation.name == loaded.clip.name) stored = frames_in_extras(skeleton, animation.extras_json);
  std::vector<BodyPose> segments;
  for (const Pose& pose : loaded.clip.frames) {
    segments.push_back(canonical_segments_of(skeleton, loaded.humanoid, pose));
    if (!stored) continue;
    const PerSegment<Quat> rotations = rotations_of(skeleton, *stored, pose);
    for (int i = 0; i < kSegmentCount; ++i)
      segments.back()[i].rotation = loaded.humanoid.world_from_file.rotation * rotations[i];
  }
  return segments;
}

Result<std::unique_ptr<Loaded>> load_clip(const std::string& file, const RenderSettings& settings,
                                          Diagnostics& diagnostics) {
  const auto path = character_path(file);
  if (!path) return path.error();
  auto character = load_character(*path, LoadOptions{}, diagnostics);
  if (!character) return character.error();
  auto clip = clip_to_draw(*character, settings);
  if (!clip) return clip.error();
  auto humanoid = map_humanoid(*character, settings.humanoid, diagnostics);
  if (!humanoid) return humanoid.error();
  auto loaded = std::make_unique<Loaded>(
      Loaded{std::move(*character), std::move(*humanoid), std::move(*clip), std::nullopt, {}});
  put_on_floor(loaded->character, loaded->humanoid,
               floor_of(loaded->character, loaded->humanoid, loaded->clip.frames), loaded->clip);
  const Overlays& overlays = settings.overlays;
  if (!overlays.shapes && !overlays.axes && !overlays.ranges && !loaded->character.parts.empty())
    return loaded;
  loaded->segments = segments_in(*loaded);
  auto body = build_body(loaded->character, loaded->humanoid, loaded->clip.frames.front(),
                         loaded->segments.front(), BodyOptions{}, diagnostics);
  if (!body) return body.error();
  loaded->body = std::move(*body);
  return loaded;
}

/// The frames' largest excess over the ranges, as drawn.
Fact excess_fact(const Loaded& loaded, const RangeOfMotion& range) {
  double most = 0.0;
  std::string_view worst;
  for (const BodyPose& pose : loaded.segments) {
    const PerJoint<SwingTwist> charts = charts_of(range, rotations_of(pose));
    for (int j = 0; j < kJointCount; ++j) {
      if (loaded.body->joints[j].fused || excess(range.joints[j], charts[j]) <= most) continue;
      most = excess(range.joints[j], charts[j]);
      worst = name(joint_at(j));
    }
  }
  return {"largest excess", worst.empty() ? "none" : fmt::format("{:.2f}° ({})", degrees(most), worst)};
}

Shot shot_of(const Loaded& loaded, const RangeOfMotion* range) {
  Shot shot;
  shot.character = &loaded.character;
  shot.humanoid = &loaded.humanoid;
  shot.clip = &loaded.clip;
  if (loaded.body) {
    shot.body = &*loaded.body;
    shot.segments = &loaded.segments;
  }
  shot.range = range;
  shot.title = fmt::format("{}: {}", loaded.character.name, loaded.clip.name);
  if (loaded.clip.frames.size() > 1)
    shot.facts.push_back({"duration", fmt::format("{:.2f} s", loaded.clip.duration_s())});
  shot.facts.push_back({"height", fmt::format("{:.2f} m", loaded.humanoid.height_m)});
  if (range == nullptr) return shot;
  shot.facts.push_back(excess_fact(loaded, *range));
  shot.notes = {"ranges of motion: a cone per joint, amber near its edge, red outside"};
  return shot;
}

Clip clip_on_floor(const Character& character, const BakedClip& outcome) {
  Clip clip = outcome.timeline.clip;
  put_on_floor(character, outcome.prepared.humanoid, outcome.prepared.start.floor_m, clip);
  return clip;
}

/// Contract: all four outlive the shot.
Shot shot_of(const Character& character, const BakeSettings& settings, const BakedClip& outcome,
             const Clip& clip) {
  const Trajectory& trajectory = outcome.timeline.trajectory;
  Shot shot;
  shot.character = &character;
  shot.humanoid = &outcome.prepared.humanoid;
  shot.clip = &clip;
  shot.body = &outcome.prepared.body;
  shot.segments = &trajectory.frames;
  shot.props = &trajectory.props;
  shot.impact_point = trajectory.impact_point;
  shot.impact_direction = trajectory.impact_direction;
  shot.title = fmt::format("{}: {}", character.name, blow_in_words(settings, outcome.prepared.scene));
  shot.facts = facts_of(settings, outcome);
  return shot;
}

}  // namespace

Result<std::vector<std::uint8_t>> bake_sheet(const Character& character, const BakeSettings& settings,
                                             const BakedClip& outcome) {
  const Clip clip = clip_on_floor(character, outcome);
  SheetOptions options;
  options.theme = settings.theme;
  options.overlays.trail = true;
  options.overlays.prints = !outcome.behaviour.steps.empty();
  const auto picture = render_sheet(shot_of(character, settings, outcome, clip), options);
  if (!picture) return picture.error();
  return encode_png(*picture);
}

Result<std::vector<std::uint8_t>> bake_thumbnail(const Character& character, const BakeSettings& settings,
                                                 const BakedClip& outcome, int width, int height) {
  const Clip clip = clip_on_floor(character, outcome);
  const auto pictures = render_thumbnails(shot_of(character, settings, outcome, clip), width, height);
  if (!pictures) return pictures.error();
  return encode_webp(settings.theme == ThemeKind::dark ? pictures->dark : pictures->light, kThumbnailQuality);
}

Result<std::vector<std::uint8_t>> bake_preview(const Character& character, const BakeSettings& settings,
                                               const BakedClip& outcome) {
  const Clip clip = clip_on_floor(character, outcome);
  MovingOptions options;
  options.theme = settings.theme;
  return render_webp(shot_of(character, settings, outcome, clip), options);
}

namespace {

Result<Picture> sheet_of(const std::vector<Shot>& shots, const RenderSettings& settings) {
  SheetOptions options;
  options.overlays = settings.overlays;
  options.theme = settings.theme;
  options.view = settings.view;
  const bool several = shots.size() > 1;
  std::size_t frames = 0;
  for (const Shot& shot : shots) frames = std::max(frames, shot.clip->frames.size());
  options.cells =
      std::min(settings.cells.value_or(several ? kStripCells : options.cells), static_cast<int>(frames));
  if (settings.columns) options.columns = *settings.columns;
  if (several) {
    options.cell_width = kStripCellWidth;
    options.cell_height = kStripCellHeight;
  }
  if (settings.size) {
    const auto [width, height] = *settings.size;
    auto fitted = several ? fit_strips(options, static_cast<int>(shots.size()), width, height)
                          : fit_sheet(options, width, height);
    if (!fitted) return fitted.error();
    options = *fitted;
  }
  if (!several) return render_sheet(shots.front(), options);
  return render_strips(shots, {fmt::format("{} clips at the same times", shots.size()), options});
}

MovingOptions moving_options(const RenderSettings& settings) {
  MovingOptions options;
  if (settings.size) {
    options.width = (*settings.size)[0];
    options.height = (*settings.size)[1];
  }
  options.fps = settings.fps;
  options.speed = settings.speed;
  options.turn_s = settings.turn_s;
  options.overlays = settings.overlays;
  options.theme = settings.theme;
  options.view = settings.view;
  return options;
}

/// "hit_###.png", 7: "hit_007.png".
std::filesystem::path numbered(const std::filesystem::path& pattern, std::size_t number) {
  std::string file = pattern.filename().string();
  const std::size_t first = file.find('#');
  const std::size_t end = std::min(file.find_first_not_of('#', first), file.size());
  file.replace(first, end - first, fmt::format("{:0{}}", number, end - first));
  return pattern.parent_path() / file;
}

Result<std::vector<OutputFile>> sequence_of(const Shot& shot, const std::filesystem::path& pattern,
                                            const RenderSettings& settings) {
  std::vector<OutputFile> files;
  const Status drawn = render_moving(shot, moving_options(settings), [&](const Picture& picture) -> Status {
    auto png = encode_png(picture);
    if (!png) return png.error();
    files.push_back({numbered(pattern, files.size()), std::move(*png)});
    return Done{};
  });
  if (!drawn) return drawn.error();
  return files;
}

Result<std::vector<OutputFile>> pictures_of(const std::vector<Shot>& shots, PictureKind kind,
                                            const std::filesystem::path& output,
                                            const RenderSettings& settings) {
  if (kind == PictureKind::sequence) return sequence_of(shots.front(), output, settings);
  if (kind == PictureKind::moving) {
    auto webp = render_webp(shots.front(), moving_options(settings));
    if (!webp) return webp.error();
    return std::vector<OutputFile>{{output, std::move(*webp)}};
  }
  const auto sheet = sheet_of(shots, settings);
  if (!sheet) return sheet.error();
  auto png = encode_png(*sheet);
  if (!png) return png.error();
  return std::vector<OutputFile>{{output, std::move(*png)}};
}

}  // namespace

Result<PictureKind> picture_kind(const std::filesystem::path& output) {
  std::string extension = output.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool numbered = output.filename().string().find('#') != std::string::npos;
  if (extension == ".webp" && !numbered) return PictureKind::moving;
  if (extension == ".png") return numbered ? PictureKind::sequence : PictureKind::sheet;
  return usage_error(output, "unknown picture format",
                     "let the name end in .png (a sheet), _####.png (a picture per frame) or .webp (moving)");
}

Result<Rendered> render_files(const std::vector<std::string>& files, const std::filesystem::path& output,
                              const RenderSettings& settings, Diagnostics& diagnostics) {
  const auto kind = picture_kind(output);
  if (!kind) return kind.error();
  if (files.size() > 1 && *kind != PictureKind::sheet)
    return usage_error("a moving picture shows one clip", "name one file, or ask for a sheet: -o NAME.png");
  std::optional<RangeOfMotion> range;
  if (settings.overlays.ranges) {
    auto region = load_range_of_motion(settings.region);
    if (!region) return region.error();
    range = std::move(*region);
  }
  std::vector<std::unique_ptr<Loaded>> loaded;
  std::vector<Shot> shots;
  Rendered rendered;
  for (const std::string& file : files) {
    auto clip = load_clip(file, settings, diagnostics);
    if (!clip) return clip.error();
    rendered.clips.push_back({file, (*clip)->clip.name, (*clip)->clip.duration_s()});
    shots.push_back(shot_of(**clip, range ? &*range : nullptr));
    loaded.push_back(std::move(*clip));
  }
  auto pictures = pictures_of(shots, *kind, output, settings);
  if (!pictures) return pictures.error();
  rendered.files = std::move(*pictures);
  return rendered;
}

Result<ViewAngles> parse_view(std::string_view text) {
  const auto direction = parse_direction(text);
  if (!direction) return direction.error();
  const bool level = text != "above" && text.find(',') == std::string_view::npos;
  return ViewAngles{direction->azimuth, level ? kLevelElevation : direction->elevation};
}

Result<std::array<int, 2>> parse_picture_size(std::string_view text) {
  for (const auto& [word, size] : kPictureSizes)
    if (text == word) return size;
  const std::size_t cross = text.find('x');
  if (cross != std::string_view::npos) {
    const auto width = number_in(text.substr(0, cross));
    const auto height = number_in(text.substr(cross + 1));
    if (width && height && std::min(*width, *height) >= 1.0 && std::max(*width, *height) <= 10000.0 &&
        *width == std::floor(*width) && *height == std::floor(*height))
      return std::array<int, 2>{static_cast<int>(*width), static_cast<int>(*height)};
  }
  return usage_error(fmt::format("'{}' is not a size", text),
                     "give thumbnail, screen, a4, a3 or WIDTHxHEIGHT in pixels: 1280x720");
}

}  // namespace ukemi
