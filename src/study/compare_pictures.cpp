#include "study/compare_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "humanoid/rotations.h"
#include "render/chart.h"
#include "render/rows.h"

namespace ukemi {
namespace {

constexpr const char* kLegend = "red: joints more than 1 degree outside the human range of motion";
const double kMarked = radians(1.0);  // excess from which a joint is marked

/// A joint outside its range in one frame.
struct Outside {
  Joint joint;
  double excess;  // rad
};

/// One method's run of the shown hit, as it is drawn.
struct Shown {
  std::string method;
  Trial trial;
  Clip clip;
  std::vector<std::vector<Outside>> outside;  // per frame, worst first
};

std::string title_of(const std::string& method) {
  if (method == "a") return "(a) each axis on its own";
  if (method == "b") return "(b) geometric range";
  if (method == "c") return "(c) geometric range and active restriction";
  return method;
}

std::vector<Outside> outside_in(const RangeOfMotion& range, const BodyPose& segments,
                                const ArticulatedBody& body) {
  const PerJoint<SwingTwist> charts = charts_of(range, rotations_of(segments));
  std::vector<Outside> outside;
  for (int j = 0; j < kJointCount; ++j) {
    const double value = excess(range.joints[j], charts[j]);
    if (!body.joints[j].fused && value > kMarked) outside.push_back({joint_at(j), value});
  }
  std::stable_sort(outside.begin(), outside.end(),
                   [](const Outside& a, const Outside& b) { return a.excess > b.excess; });
  return outside;
}

/// A run that ended early holds its last frame.
void hold_last_frame(Trajectory& trajectory, double duration_s) {
  const auto frames = static_cast<std::size_t>(std::lround(duration_s * trajectory.fps)) + 1;
  if (trajectory.frames.empty()) return;
  trajectory.frames.resize(frames, trajectory.frames.back());
  for (Prop& prop : trajectory.props)
    if (!prop.poses.empty()) prop.poses.resize(frames, prop.poses.back());
}

Result<Shown> run_shown(const Character& character, const Comparison& comparison, const Method& method,
                        const Scene& scene) {
  auto trial = run_scene(comparison, method, scene);
  if (!trial) return trial.error();
  Shown shown{method.name, std::move(*trial), {}, {}};
  Trajectory& trajectory = shown.trial.result.trajectory;
  hold_last_frame(trajectory, duration_of(method.simulation));
  const Prepared& prepared = comparison.prepared;
  ResampleError error;
  shown.clip =
      resample(character, prepared.humanoid, prepared.start.pose, prepared.start.segments, trajectory, error);
  shown.clip.name = method.name;
  shown.clip.marks = {{"impact", 0.0}};
  for (const BodyPose& frame : trajectory.frames)
    shown.outside.push_back(outside_in(comparison.judged, frame, prepared.body));
  return shown;
}

std::string note_of(const Shown& shown) {
  const LimitFigures& limits = shown.trial.result.limits;
  const double share =
      limits.samples > 0 ? static_cast<double>(limits.over_1deg) / static_cast<double>(limits.samples) : 0.0;
  std::string note = fmt::format("{} of the joint samples over 1 degree outside, at most {:.1f} degrees",
                                 limits.over_1deg > 0 ? fmt::format("{:.3g} %", 100.0 * share) : "none",
                                 limits.excess_max_deg);
  if (shown.trial.failure) note += ";  " + shown.trial.failure->what;
  return note;
}

MarkedShot marked_shot(const Character& character, const Comparison& comparison, const Shown& shown) {
  const Trajectory& trajectory = shown.trial.result.trajectory;
  MarkedShot row;
  row.shot.character = &character;
  row.shot.humanoid = &comparison.prepared.humanoid;
  row.shot.clip = &shown.clip;
  row.shot.body = &comparison.prepared.body;
  row.shot.segments = &trajectory.frames;
  row.shot.props = &trajectory.props;
  row.shot.impact_point = trajectory.impact_point;
  row.shot.impact_direction = trajectory.impact_direction;
  row.shot.title = title_of(shown.method);
  row.shot.notes = {note_of(shown)};
  for (std::size_t frame = 0; frame < shown.outside.size(); ++frame) {
    std::vector<Marker> markers;
    for (const Outside& outside : shown.outside[frame])
      markers.push_back({trajectory.frames[frame][index(child_of(outside.joint))].translation,
                         fmt::format("{} {:.0f}°", name(outside.joint), degrees(outside.excess))});
    row.markers.push_back(std::move(markers));
  }
  return row;
}

/// The scene with a, b, c and ours.
Result<std::vector<Shown>> run_all(const Character& character, const Comparison& comparison,
                                   const Scene& scene) {
  std::vector<Shown> runs;
  for (const MethodFigures& figures : comparison.methods) {
    const std::string& method = figures.method.name;
    if (method != "a" && method != "b" && method != "c" && method != "ours") continue;
    auto run = run_shown(character, comparison, figures.method, scene);
    if (!run) return run.error();
    runs.push_back(std::move(*run));
  }
  return runs;
}

/// They point into the runs.
std::vector<MarkedShot> marked_shots(const Character& character, const Comparison& comparison,
                                     const std::vector<Shown>& runs) {
  std::vector<MarkedShot> rows;
  for (const Shown& run : runs) rows.push_back(marked_shot(character, comparison, run));
  return rows;
}

RowsOptions sheet_of(const Comparison& comparison, const std::string& what) {
  RowsOptions options;
  options.title = fmt::format("{}: {}", comparison.character, what);
  options.notes = {kLegend};
  return options;
}

/// A scene of the experiment that no random hit shows.
struct StagedScene {
  const char* file;
  const char* title;
  Scene scene;
};

std::vector<StagedScene> staged_scenes(const Quat& world_from_pelvis) {
  Scene slope;
  slope.kind = SceneKind::slope;
  slope.target = Segment::thigh_l;
  slope.direction = travel_direction({radians(30.0), 0.0}, world_from_pelvis);
  slope.ball_mass_kg = 10.0;
  slope.ball_speed_m_s = 6.0;
  slope.ball_radius_m = 0.25;
  Scene fall;
  fall.kind = SceneKind::fall;
  fall.direction = travel_direction({radians(140.0), 0.0}, world_from_pelvis);
  fall.fall_height_m = 0.8;
  fall.tip_speed_m_s = 2.0;
  return {{"slope.png", "a ball of 10 kg rolls down a slope into the body at 6 m/s", slope},
          {"fall.png", "the body tips over at 2 m/s and drops 0.8 m", fall}};
}

Result<Picture> draw_chart(const Comparison& comparison) {
  Chart chart;
  chart.title =
      fmt::format("{}: {} random hits with each method", comparison.character, comparison.settings.hits);
  chart.notes = {"how far joints lie outside the human range of motion, every step, before any clean-up"};
  ChartPanel p999{"99.9th percentile", "degrees", {}};
  ChartPanel worst{"maximum", "degrees", {}};
  ChartPanel over{"samples over 1 degree outside", "%", {}};
  for (const MethodFigures& figures : comparison.methods) {
    chart.rows.push_back(figures.method.name);
    chart.strong.push_back(figures.method.name.starts_with("ours"));
    p999.values.push_back(figures.excess_p999_deg);
    worst.values.push_back(figures.excess_max_deg);
    over.values.push_back(100.0 * static_cast<double>(figures.over_1deg) /
                          static_cast<double>(std::max(figures.samples, 1L)));
  }
  chart.panels = {std::move(over), std::move(p999), std::move(worst)};
  return render_chart(chart);
}

Result<Picture> draw_unnatural(const Comparison& comparison, const MarkedShot& row, const Shown& shown,
                               const std::string& what) {
  CloseUpOptions options;
  double most = 0.0;
  for (std::size_t frame = 0; frame < shown.outside.size(); ++frame) {
    if (shown.outside[frame].empty() || shown.outside[frame].front().excess <= most) continue;
    most = shown.outside[frame].front().excess;
    options.frame = static_cast<int>(frame);
  }
  options.title = "(a) no joint outside its range";
  options.focus = shown.trial.result.trajectory.frames[options.frame][index(Segment::chest)].translation;
  if (most > 0.0) {
    const Joint joint = shown.outside[options.frame].front().joint;
    options.title =
        fmt::format("(a) unnatural joint: {} {:.0f} degrees outside its range", name(joint), degrees(most));
    options.focus = row.markers[options.frame].front().place;
  }
  options.radius_m = 0.2 * comparison.prepared.humanoid.height_m;
  options.notes = {what, kLegend};
  return render_close_up(row, options);
}

}  // namespace

int hit_to_show(const Comparison& comparison) {
  const auto whole = [&](int hit) {
    return std::none_of(comparison.methods.begin(), comparison.methods.end(),
                        [&](const MethodFigures& figures) { return figures.exploded_hits[hit]; });
  };
  const std::vector<double>& outside = comparison.methods.front().excess_max_by_hit_deg;
  int best = 0;
  for (int hit = 1; hit < static_cast<int>(outside.size()); ++hit)
    if (std::pair(whole(hit), outside[hit]) > std::pair(whole(best), outside[best])) best = hit;
  return best;
}

Result<std::vector<NamedPicture>> comparison_pictures(const Character& character,
                                                      const Comparison& comparison, int shown) {
  const Quat& pelvis = comparison.prepared.start.segments[index(Segment::pelvis)].rotation;
  const std::string hit = fmt::format("hit {} of seed {}: {}", shown + 1, comparison.settings.seed,
                                      describe(comparison.hits[shown]));
  const auto runs = run_all(character, comparison, scene_of(comparison.hits[shown], pelvis));
  if (!runs) return runs.error();
  const std::vector<MarkedShot> rows = marked_shots(character, comparison, *runs);
  std::vector<NamedPicture> pictures;
  const auto add = [&](const std::string& name, const Result<Picture>& picture) -> Status {
    if (!picture) return picture.error();
    auto png = encode_png(*picture);
    if (!png) return png.error();
    pictures.push_back({name, std::move(*png)});
    return Done{};
  };
  std::vector<Status> made = {add("compare.png", draw_chart(comparison)),
                              add("hit.png", render_rows(rows, sheet_of(comparison, hit)))};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    RowsOptions alone = sheet_of(comparison, hit);
    alone.only = i;
    made.push_back(add((*runs)[i].method + ".png", render_rows(rows, alone)));
  }
  made.push_back(add("unnatural.png", draw_unnatural(comparison, rows.front(), runs->front(), hit)));
  for (const StagedScene& staged : staged_scenes(pelvis)) {
    const auto others = run_all(character, comparison, staged.scene);
    if (!others) return others.error();
    made.push_back(add(staged.file, render_rows(marked_shots(character, comparison, *others),
                                                sheet_of(comparison, staged.title))));
  }
  for (const Status& status : made)
    if (!status) return status.error();
  return pictures;
}

}  // namespace ukemi
