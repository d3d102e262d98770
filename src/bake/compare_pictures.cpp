#include "bake/compare_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/chart.h"
#include "render/rows.h"

namespace ukemi {
namespace {

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
  PerSegment<Quat> rotations;
  for (int s = 0; s < kSegmentCount; ++s) rotations[s] = segments[s].rotation;
  const PerJoint<SwingTwist> charts = charts_of(range, rotations);
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
                        const RandomHit& hit) {
  auto trial = run_hit(comparison, method, hit);
  if (!trial) return trial.error();
  Shown shown{method.name, std::move(*trial), {}, {}};
  Trajectory& trajectory = shown.trial.result.trajectory;
  hold_last_frame(trajectory, method.simulation.duration_s);
  const BakeOutcome& prepared = comparison.prepared;
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
  std::string note = fmt::format(
      "{:.2f} % of the joint samples over 1 degree outside, at most {:.1f} degrees",
      limits.samples > 0 ? 100.0 * static_cast<double>(limits.over_1deg) / static_cast<double>(limits.samples)
                         : 0.0,
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

Result<NamedPicture> named(const std::string& name, const Result<Picture>& picture) {
  if (!picture) return picture.error();
  auto png = encode_png(*picture);
  if (!png) return png.error();
  return NamedPicture{name, std::move(*png)};
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
                               const std::vector<std::string>& notes) {
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
  options.notes = notes;
  return render_close_up(row, options);
}

}  // namespace

int hit_to_show(const Comparison& comparison) {
  const auto whole = [&](int hit) {
    return std::none_of(comparison.methods.begin(), comparison.methods.end(),
                        [&](const MethodFigures& figures) { return figures.exploded_hits[hit]; });
  };
  const std::vector<long>& outside = comparison.methods.front().over_1deg_by_hit;
  int best = 0;
  for (int hit = 1; hit < static_cast<int>(outside.size()); ++hit)
    if (std::pair(whole(hit), outside[hit]) > std::pair(whole(best), outside[best])) best = hit;
  return best;
}

Result<std::vector<NamedPicture>> comparison_pictures(const Character& character,
                                                      const Comparison& comparison, int shown) {
  const RandomHit& hit = comparison.hits[shown];
  std::vector<Shown> runs;
  for (const MethodFigures& figures : comparison.methods) {
    const std::string& method = figures.method.name;
    if (method != "a" && method != "b" && method != "c" && method != "ours") continue;
    auto run = run_shown(character, comparison, figures.method, hit);
    if (!run) return run.error();
    runs.push_back(std::move(*run));
  }
  std::vector<MarkedShot> rows;
  for (const Shown& run : runs) rows.push_back(marked_shot(character, comparison, run));

  const std::string what =
      fmt::format("hit {} of seed {}: {}", shown + 1, comparison.settings.seed, describe(hit));
  RowsOptions options;
  options.title = fmt::format("{}: {}", comparison.character, what);
  options.notes = {"red: joints more than 1 degree outside the human range of motion"};
  std::vector<NamedPicture> pictures;
  const auto add = [&](const std::string& name, const Result<Picture>& picture) -> Status {
    auto made = named(name, picture);
    if (!made) return made.error();
    pictures.push_back(std::move(*made));
    return Done{};
  };
  if (const Status status = add("compare.png", draw_chart(comparison)); !status) return status.error();
  if (const Status status = add("hit.png", render_rows(rows, options)); !status) return status.error();
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (const Status status = add(runs[i].method + ".png", render_rows({rows[i]}, options)); !status)
      return status.error();
  options.notes.insert(options.notes.begin(), what);
  if (const Status status =
          add("unnatural.png", draw_unnatural(comparison, rows.front(), runs.front(), options.notes));
      !status)
    return status.error();
  return pictures;
}

}  // namespace ukemi
