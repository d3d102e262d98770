#include "check/rom.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bake/report.h"
#include "base/character_path.h"
#include "base/errors.h"
#include "base/nearest.h"
#include "clip/names.h"
#include "load/load.h"
#include "physics/swing.h"
#include "render/rom_plot.h"
#include "restrict/limit_rows.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPull = 6.0;           // rad/s^2
constexpr double kSwingDamping = 1.5;   // 1/s
constexpr double kSwingDuration = 2.0;  // s
constexpr double kSwingRate = 480.0;    // 1/s
constexpr int kOverviewColumns = 7;

Status check_settings(const RomSettings& settings) {
  const int uses = settings.check.has_value() + settings.state.has_value() + settings.swing;
  if (uses > 1) return usage_error("--check, --state and --swing exclude each other", "give one of them");
  if (settings.clip && !settings.check) return usage_error("--clip needs a file", "add --check FILE");
  if (settings.joint) return Done{};
  if (settings.state) return usage_error("--state needs a joint", "add --joint NAME");
  if (settings.swing) return usage_error("--swing needs a joint", "add --joint NAME");
  return Done{};
}

Result<std::vector<Joint>> joints_of(const RomSettings& settings) {
  std::vector<Joint> all;
  std::vector<std::string> names;
  for (int j = 0; j < kJointCount; ++j) {
    all.push_back(joint_at(j));
    names.emplace_back(name(joint_at(j)));
  }
  if (!settings.joint) return all;
  const auto joint = joint_named(*settings.joint);
  if (!joint)
    return usage_error(fmt::format("unknown joint '{}'", *settings.joint),
                       suggestion(*settings.joint, names));
  return std::vector<Joint>{*joint};
}

/// The file to check and the clip in it: a clip of the mannequin goes by its name alone.
Result<Character> load_to_check(const RomSettings& settings, std::optional<std::string>& clip,
                                Diagnostics& diagnostics) {
  std::error_code error;
  const bool is_file = *settings.check == "mannequin" || std::filesystem::exists(*settings.check, error);
  if (!is_file && !settings.clip) {
    const auto mannequin = character_path("mannequin");
    if (!mannequin) return mannequin.error();
    auto character = load_character(*mannequin, LoadOptions{}, diagnostics);
    if (!character) return character;
    if (find_clip(*character, *settings.check)) {
      clip = settings.check;
      return character;
    }
  }
  const auto path = character_path(*settings.check);
  if (!path) return path.error();
  return load_character(*path, LoadOptions{}, diagnostics);
}

/// Checks the clip; `range` becomes the range that it was judged by.
Result<RomCheck> check_clip(const RomSettings& settings, RangeOfMotion& range, Diagnostics& diagnostics) {
  std::optional<std::string> wanted = settings.clip;
  const auto character = load_to_check(settings, wanted, diagnostics);
  if (!character) return character.error();
  if (character->animations.empty())
    return input_error(character->path, "holds no clips", "choose a file with motion");
  std::size_t clip = character->animations.size() - 1;
  if (wanted) {
    const auto found = find_clip(*character, *wanted);
    if (!found) return found.error();
    clip = *found;
  }
  const auto humanoid = map_humanoid(*character, settings.humanoid, diagnostics);
  if (!humanoid) return humanoid.error();
  range = range_of_clip(range, *character, clip);
  const Clip sampled = clip_to_check(*character, clip);
  RomCheck check{*settings.check, sampled.name, sampled.fps, sampled.duration_s(), 0, {}, {}};
  check.frames = static_cast<long>(sampled.frames.size());
  check.paths = rom_paths(ClipToCheck{&*character, clip, settings.humanoid}, *humanoid, range);
  check.figures = rom_figures(check.paths);
  return check;
}

/// Towards the corner of the bounding box that lies furthest outside the polygon.
Vec2 towards_cut_corner(const std::vector<Vec2>& polygon) {
  Vec2 low = Vec2::Zero(), high = Vec2::Zero();
  for (const Vec2& corner : polygon) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  Vec2 furthest = high;
  for (const Vec2& corner : {Vec2(low.x(), high.y()), low, Vec2(high.x(), low.y())})
    if (polygon_distance(polygon, corner) > polygon_distance(polygon, furthest) + 1e-9) furthest = corner;
  return furthest.normalized();
}

Result<std::vector<RomSwing>> swings_of(const JointRange& range) {
  std::vector<RomSwing> swings;
  for (const Limits limits : {Limits::axis, Limits::segments, Limits::edges}) {
    SwingSettings settings;
    settings.limits = limits;
    settings.pull = kPull * towards_cut_corner(range.polygon);
    settings.damping = kSwingDamping;
    settings.duration_s = kSwingDuration;
    settings.rate_hz = kSwingRate;
    auto charts = swing_joint(range, settings);
    if (!charts) return charts.error();
    RomSwing swing{limits, kSwingRate, {}};
    for (const SwingTwist& chart : *charts) swing.path.excess_deg.push_back(degrees(excess(range, chart)));
    swing.path.charts = std::move(*charts);
    swings.push_back(std::move(swing));
  }
  return swings;
}

double rounded_degrees(double angle) { return std::round(degrees(angle) * 1e6) / 1e6; }

Json pair_deg(double low, double high) { return {rounded_degrees(low), rounded_degrees(high)}; }

Json figures_json(const JointRomFigures& figures) {
  return {{"over_1deg_fraction", figures.over_1deg_fraction},
          {"over_5deg_fraction", figures.over_5deg_fraction},
          {"excess_max_deg", figures.excess_max_deg}};
}

Json state_json(const JointRange& range, const Vec2& state) {
  const ChordStops stops = chord_stops(range, {state, 0.0});
  return {{"a_deg", pair_deg(state.x(), state.y())},
          {"inside", polygon_distance(range.polygon, state) <= 0.0},
          {"chord_a_y_deg", pair_deg(stops.a_y[0], stops.a_y[1])},
          {"chord_a_z_deg", pair_deg(stops.a_z[0], stops.a_z[1])}};
}

Json swing_json(const RomSwing& swing) {
  Json json = figures_json(rom_figures(swing.path));
  const Vec2 end = swing.path.charts.back().swing;
  json["end_deg"] = pair_deg(end.x(), end.y());
  json["fps"] = swing.fps;
  json["a_deg"] = Json::array();
  for (const SwingTwist& chart : swing.path.charts)
    json["a_deg"].push_back(pair_deg(chart.swing.x(), chart.swing.y()));
  return json;
}

Json joint_json(const Rom& rom, Joint joint) {
  const JointRange& range = rom.range.joints[index(joint)];
  Json json;
  json["polygon_deg"] = Json::array();
  for (const Vec2& corner : range.polygon) json["polygon_deg"].push_back(pair_deg(corner.x(), corner.y()));
  json["twist_deg"] = pair_deg(range.twist_min, range.twist_max);
  json["area_deg2"] = polygon_area(range.polygon) * degrees(1.0) * degrees(1.0);
  const char* axes[] = {"a_y", "a_z", "alpha"};
  for (std::size_t i = 0; i < 3; ++i)
    json["meanings"][axes[i]] = {range.meanings[i].negative, range.meanings[i].positive};
  if (rom.check && !rom.check->paths.joints[index(joint)].charts.empty()) {
    json["check"] = figures_json(*rom.check->figures.joints[index(joint)]);
    json["check"]["excess_deg"] = rom.check->paths.joints[index(joint)].excess_deg;
  }
  if (rom.state) json["state"] = state_json(range, *rom.state);
  for (const RomSwing& swing : rom.swings) json["swing"][std::string(name(swing.limits))] = swing_json(swing);
  return json;
}

Vec2 lowest(const std::vector<Vec2>& polygon) {
  Vec2 low = polygon.front();
  for (const Vec2& corner : polygon) low = low.cwiseMin(corner);
  return low;
}

Vec2 highest(const std::vector<Vec2>& polygon) {
  Vec2 high = polygon.front();
  for (const Vec2& corner : polygon) high = high.cwiseMax(corner);
  return high;
}

std::string interval(double low, double high) {
  return fmt::format("{:.0f} to {:.0f}", degrees(low), degrees(high));
}

std::string both(const AxisMeaning& meaning) {
  return meaning.positive.empty() ? "" : meaning.negative + " / " + meaning.positive;
}

std::string ranges_text(const Rom& rom) {
  std::string text = fmt::format("{:<11} {:<11} {:<44} {:<11} {:<32} {:<12} {:<38} {}\n", "joint", "a_y", "",
                                 "a_z", "", "alpha", "", "area, deg^2");
  for (const Joint joint : rom.joints) {
    const JointRange& range = rom.range.joints[index(joint)];
    const Vec2 low = lowest(range.polygon), high = highest(range.polygon);
    text += fmt::format("{:<11} {:<11} {:<44} {:<11} {:<32} {:<12} {:<38} {:.0f}\n", name(joint),
                        interval(low.x(), high.x()), both(range.meanings[0]), interval(low.y(), high.y()),
                        both(range.meanings[1]), interval(range.twist_min, range.twist_max),
                        both(range.meanings[2]), polygon_area(range.polygon) * degrees(1.0) * degrees(1.0));
  }
  return text;
}

std::string check_text(const Rom& rom) {
  const RomCheck& check = *rom.check;
  std::string text = fmt::format(
      "clip '{}': {:.2f} s, {} frames, {:.2f} % of the joint samples over 1 degree "
      "outside, {:.2f} % over 5, rolls {}\n",
      check.clip, check.duration_s, check.frames, 100.0 * check.figures.over_1deg_fraction,
      100.0 * check.figures.over_5deg_fraction, name(check.figures.rolls));
  text += fmt::format("{:<11} {:>9} {:>9} {:>9}\n", "joint", "over 1", "over 5", "at most");
  for (const Joint joint : rom.joints) {
    const auto& figures = check.figures.joints[index(joint)];
    if (!figures) continue;
    text += fmt::format("{:<11} {:>7.2f} % {:>7.2f} % {:>9.2f}\n", name(joint),
                        100.0 * figures->over_1deg_fraction, 100.0 * figures->over_5deg_fraction,
                        figures->excess_max_deg);
  }
  return text;
}

std::string end_text(const Vec2& swing) {
  return fmt::format("({:.1f}, {:.1f})", degrees(swing.x()), degrees(swing.y()));
}

std::string check_title(const RomCheck& check) {
  const std::string file = std::filesystem::path(check.file).filename().string();
  return file == check.clip ? file : file + " · " + check.clip;
}

RomFigure titled(const Rom& rom, const std::string& subject) {
  RomFigure figure;
  figure.title = rom.check ? fmt::format("{}  ·  {}", check_title(*rom.check), subject) : subject;
  figure.notes.push_back(
      fmt::format("range of motion '{}': swing (a_y, a_z) inside the polygon, twist α inside its interval",
                  std::filesystem::path(rom.range.name).filename().string()));
  return figure;
}

std::string share_text(const JointRomFigures& figures) {
  return fmt::format("{:.1f} % over 1°, at most {:.1f}°", 100.0 * figures.over_1deg_fraction,
                     figures.excess_max_deg);
}

/// Paths as the figures take them; joints that do not move have none.
PerJoint<RomPath> drawn_paths(const Rom& rom) {
  PerJoint<RomPath> paths;
  if (rom.check)
    for (int j = 0; j < kJointCount; ++j)
      paths[j] = {rom.check->paths.joints[j].charts, rom.check->paths.joints[j].excess_deg, rom.check->fps};
  return paths;
}

Result<Picture> joint_picture(const Rom& rom) {
  const Joint joint = rom.joints.front();
  const JointRange& range = rom.range.joints[index(joint)];
  RomFigure figure = titled(rom, std::string(name(joint)));
  RomPanel panel{std::string(name(joint)), {}, &range, nullptr, {}};
  const PerJoint<RomPath> paths = drawn_paths(rom);
  if (!paths[index(joint)].charts.empty()) {
    panel.path = &paths[index(joint)];
    const JointRomFigures& figures = *rom.check->figures.joints[index(joint)];
    figure.notes.push_back(
        fmt::format("{} frames: {:.2f} % over 1 degree outside, {:.2f} % over 5, at most "
                    "{:.2f} degrees",
                    rom.check->frames, 100.0 * figures.over_1deg_fraction, 100.0 * figures.over_5deg_fraction,
                    figures.excess_max_deg));
  }
  if (rom.state) {
    panel.state = RomPanel::State{*rom.state, chord_stops(range, {*rom.state, 0.0})};
    figure.notes.push_back(
        "the horizontal chord through the state gives the stops of a_y, the vertical one those of a_z");
  }
  figure.panels.push_back(std::move(panel));
  return draw_rom_joint(figure);
}

Result<Picture> overview_picture(const Rom& rom) {
  constexpr std::array kRows = {std::array{Joint::spine, Joint::chest, Joint::neck, Joint::spine,
                                           Joint::spine, Joint::spine, Joint::spine},
                                std::array{Joint::clavicle_l, Joint::shoulder_l, Joint::elbow_l,
                                           Joint::wrist_l, Joint::hip_l, Joint::knee_l, Joint::ankle_l},
                                std::array{Joint::clavicle_r, Joint::shoulder_r, Joint::elbow_r,
                                           Joint::wrist_r, Joint::hip_r, Joint::knee_r, Joint::ankle_r}};
  constexpr int kTrunkJoints = 3;
  RomFigure figure = titled(rom, "17 joints");
  const PerJoint<RomPath> paths = drawn_paths(rom);
  if (rom.check)
    figure.notes.push_back(fmt::format(
        "{:.2f} s, {} frames: {:.2f} % of the joint samples over 1 degree outside, {:.2f} % over 5",
        rom.check->duration_s, rom.check->frames, 100.0 * rom.check->figures.over_1deg_fraction,
        100.0 * rom.check->figures.over_5deg_fraction));
  for (std::size_t row = 0; row < kRows.size(); ++row)
    for (int column = 0; column < kOverviewColumns; ++column) {
      RomPanel& panel = figure.panels.emplace_back();
      if (row == 0 && column >= kTrunkJoints) continue;
      const Joint joint = kRows[row][column];
      const JointRange& range = rom.range.joints[index(joint)];
      panel.title = name(joint);
      panel.range = &range;
      panel.notes.push_back(
          fmt::format("twist {:.0f}° to {:.0f}°", degrees(range.twist_min), degrees(range.twist_max)));
      if (paths[index(joint)].charts.empty()) continue;
      panel.path = &paths[index(joint)];
      panel.notes.front() = share_text(*rom.check->figures.joints[index(joint)]);
    }
  return draw_rom_overview(figure, kOverviewColumns);
}

Result<Picture> swing_picture(const Rom& rom) {
  const Joint joint = rom.joints.front();
  const JointRange& range = rom.range.joints[index(joint)];
  RomFigure figure = titled(rom, fmt::format("a single link on {}", name(joint)));
  figure.notes.push_back(
      fmt::format("pulled for {:.0f} s towards the corner that independent ranges of the axes allow and the "
                  "joint does not",
                  kSwingDuration));
  std::vector<RomPath> paths;
  for (const RomSwing& swing : rom.swings)
    paths.push_back({swing.path.charts, swing.path.excess_deg, swing.fps});
  for (std::size_t i = 0; i < rom.swings.size(); ++i) {
    const JointRomFigures figures = rom_figures(rom.swings[i].path);
    figure.panels.push_back({std::string(name(rom.swings[i].limits)),
                             {fmt::format("at most {:.2f} degrees outside, ends at {}",
                                          figures.excess_max_deg, end_text(paths[i].charts.back().swing))},
                             &range,
                             &paths[i],
                             {}});
  }
  return draw_rom_comparison(figure);
}

}  // namespace

Result<Rom> rom_of(const RomSettings& settings, Diagnostics& diagnostics) {
  if (const Status status = check_settings(settings); !status) return status.error();
  const auto joints = joints_of(settings);
  if (!joints) return joints.error();
  auto range = load_range_of_motion(settings.region);
  if (!range) return range.error();
  Rom rom{std::move(*range), *joints, {}, settings.state, {}};
  if (settings.check) {
    auto check = check_clip(settings, rom.range, diagnostics);
    if (!check) return check.error();
    rom.check = std::move(*check);
    if (settings.joint && rom.check->paths.joints[index(rom.joints.front())].charts.empty())
      return error_about(*settings.joint,
                         input_error(*settings.check, "the character does not move this joint",
                                     "choose another joint, or --map its segment"));
  }
  if (settings.swing) {
    auto swings = swings_of(rom.range.joints[index(rom.joints.front())]);
    if (!swings) return swings.error();
    rom.swings = std::move(*swings);
  }
  return rom;
}

std::string rom_json(const Rom& rom) {
  Json json;
  json["format"] = 1;
  json["region"] = rom.range.name;
  json["joints"] = Json::object();
  for (const Joint joint : rom.joints) json["joints"][std::string(name(joint))] = joint_json(rom, joint);
  if (rom.check) {
    const RomFigures& figures = rom.check->figures;
    json["check"] = {{"file", rom.check->file},
                     {"clip", rom.check->clip},
                     {"fps", rom.check->fps},
                     {"frames", rom.check->frames},
                     {"duration_s", rom.check->duration_s},
                     {"rolls", name(figures.rolls)},
                     {"neutral", figures.neutral_from_motion ? "motion" : "rest"},
                     {"over_1deg_fraction", figures.over_1deg_fraction},
                     {"over_5deg_fraction", figures.over_5deg_fraction},
                     {"excess_max_deg", figures.excess_max_deg},
                     {"worst_joint", figures.worst_joint ? Json(name(*figures.worst_joint)) : Json(nullptr)}};
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string rom_text(const Rom& rom) {
  if (rom.check) return check_text(rom);
  std::string text = ranges_text(rom);
  if (rom.state) {
    const ChordStops stops = chord_stops(rom.range.joints[index(rom.joints.front())], {*rom.state, 0.0});
    text += fmt::format("stops at {}: a_y {:.1f} to {:.1f}, a_z {:.1f} to {:.1f}\n", end_text(*rom.state),
                        degrees(stops.a_y[0]), degrees(stops.a_y[1]), degrees(stops.a_z[0]),
                        degrees(stops.a_z[1]));
  }
  for (const RomSwing& swing : rom.swings)
    text += fmt::format("{:<9} at most {:.3f} degrees outside, ends at {}\n", name(swing.limits),
                        rom_figures(swing.path).excess_max_deg, end_text(swing.path.charts.back().swing));
  return text;
}

Result<std::vector<std::uint8_t>> rom_png(const Rom& rom) {
  const auto picture = !rom.swings.empty()      ? swing_picture(rom)
                       : rom.joints.size() == 1 ? joint_picture(rom)
                                                : overview_picture(rom);
  if (!picture) return picture.error();
  return encode_png(*picture);
}

}  // namespace ukemi
