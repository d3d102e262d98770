#include "render/moments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace ukemi {
namespace {

// Standing still counts a little, so that a long rest is not left out.
constexpr double kIdleSpeed_m_s = 0.05;
// Motion just after the impact counts up to three times, because what shows the blow is still small there.
constexpr double kImpactWeight = 2.0;
constexpr double kImpactFade_s = 0.15;
constexpr double kPeakSpeed_m_s = 0.5;  // a slower clip has no peak worth naming
constexpr double kPeakOverMean = 1.6;
constexpr int kSameMoment = 2;     // frames
constexpr double kStill_m = 0.01;  // of mean way from the mark "rest" to the end: nothing more is to be seen

double weight_at(const Clip& clip, double time_s) {
  for (const Mark& mark : clip.marks)
    if (mark.name == "impact" && time_s >= mark.time_s)
      return 1.0 + kImpactWeight * std::exp(-(time_s - mark.time_s) / kImpactFade_s);
  return 1.0;
}

/// Mean way of the points from the first frame to each frame, metres.
std::vector<double> mean_way(const std::vector<std::vector<Vec3>>& points) {
  std::vector<double> way(points.size(), 0.0);
  for (std::size_t frame = 1; frame < way.size(); ++frame) {
    double sum = 0.0;
    for (std::size_t i = 0; i < points[frame].size(); ++i)
      sum += (points[frame][i] - points[frame - 1][i]).norm();
    way[frame] =
        way[frame - 1] + (points[frame].empty() ? 0.0 : sum / static_cast<double>(points[frame].size()));
  }
  return way;
}

/// The same, weighted after the impact.
std::vector<double> travelled(const Clip& clip, const std::vector<std::vector<Vec3>>& points) {
  const std::vector<double> mean = mean_way(points);
  std::vector<double> way(mean.size(), 0.0);
  for (std::size_t frame = 1; frame < way.size(); ++frame)
    way[frame] = way[frame - 1] +
                 weight_at(clip, static_cast<double>(frame) / clip.fps) * (mean[frame] - mean[frame - 1]) +
                 kIdleSpeed_m_s / clip.fps;
  return way;
}

int frame_at(const Clip& clip, double time_s) {
  const auto last = static_cast<long>(clip.frames.size()) - 1;
  return static_cast<int>(std::clamp(std::lround(time_s * clip.fps), 0L, last));
}

/// A foot that leaves the ground or stands on it again: there may be many.
bool is_step(const std::string& name) { return name.starts_with("lift_") || name.starts_with("contact_"); }

/// Frames that the sheet must show, most wanted first.
std::vector<int> wanted_frames(const Clip& clip) {
  std::vector<int> frames{0};
  const auto add_marks = [&](auto&& chosen) {
    for (const Mark& mark : clip.marks)
      if (chosen(mark.name)) frames.push_back(frame_at(clip, mark.time_s));
  };
  add_marks([](const std::string& name) { return name == "impact"; });
  frames.push_back(static_cast<int>(clip.frames.size()) - 1);
  add_marks([](const std::string& name) { return name != "impact" && !is_step(name); });
  add_marks(is_step);
  return frames;
}

/// Divides the stretches between the fixed frames: each new frame goes where the way per piece is longest.
std::vector<int> pieces_per_stretch(const std::vector<int>& fixed, const std::vector<double>& way,
                                    int extra) {
  std::vector<int> pieces(fixed.size() - 1, 1);
  for (; extra > 0; --extra) {
    int best = -1;
    double best_way = -1.0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (pieces[i] >= fixed[i + 1] - fixed[i]) continue;
      const double way_per_piece = (way[fixed[i + 1]] - way[fixed[i]]) / pieces[i];
      if (way_per_piece > best_way) {
        best_way = way_per_piece;
        best = static_cast<int>(i);
      }
    }
    if (best < 0) break;
    ++pieces[best];
  }
  return pieces;
}

/// Frames strictly between `from` and `to` at equal ways.
void divide(std::vector<int>& frames, const std::vector<double>& way, int from, int to, int pieces) {
  int previous = from;
  for (int piece = 1; piece < pieces; ++piece) {
    const double target = way[from] + (way[to] - way[from]) * piece / pieces;
    const auto after = std::lower_bound(way.begin() + from, way.begin() + to, target);
    int frame = static_cast<int>(after - way.begin());
    if (frame > from && target - way[frame - 1] < way[frame] - target) --frame;
    frame = std::clamp(frame, previous + 1, to - (pieces - piece));
    frames.push_back(frame);
    previous = frame;
  }
}

std::string phase_at(const Clip& clip, int frame) {
  std::string phase;
  for (const Mark& mark : clip.marks) {
    if (frame_at(clip, mark.time_s) != frame) continue;
    if (!phase.empty()) phase += ", ";
    for (const char c : mark.name) phase += c == '_' ? ' ' : c;
  }
  return phase;
}

/// Marks the fastest frame where there is motion; beside another mark it is that mark's frame.
void mark_peak_speed(Clip& clip, const std::vector<std::vector<Vec3>>& points) {
  const std::vector<double> speeds = mean_speeds(clip, points);
  const auto peak = std::max_element(speeds.begin(), speeds.end());
  const double mean = std::accumulate(speeds.begin(), speeds.end(), 0.0) / static_cast<double>(speeds.size());
  if (*peak < std::max(kPeakSpeed_m_s, kPeakOverMean * mean)) return;
  int frame = static_cast<int>(peak - speeds.begin());
  for (const Mark& mark : clip.marks)
    if (std::abs(frame_at(clip, mark.time_s) - frame) <= kSameMoment) frame = frame_at(clip, mark.time_s);
  clip.marks.push_back({"peak speed", frame / clip.fps});
}

/// A rest that lasts to the end is shown by the last frame.
Clip with_rest_at_end(const Clip& clip, const std::vector<std::vector<Vec3>>& points) {
  Clip marked{clip.name, clip.fps, std::vector<Pose>(clip.frames.size()), clip.marks};
  const std::vector<Vec3>& last = points.back();
  for (Mark& mark : marked.marks) {
    const std::vector<Vec3>& there = points[frame_at(clip, mark.time_s)];
    double way = 0.0;
    for (std::size_t i = 0; i < last.size(); ++i) way += (last[i] - there[i]).norm();
    const bool still = way <= kStill_m * static_cast<double>(last.size());
    if (mark.name != "rest" || !still || frame_at(clip, mark.time_s) + 1 >= static_cast<int>(points.size()))
      continue;
    mark.name = fmt::format("at rest since {:.2f} s", mark.time_s);
    mark.time_s = clip.duration_s();
  }
  return marked;
}

}  // namespace

int halfway_frame(const Clip& clip, const std::vector<std::vector<Vec3>>& points) {
  int from = 0;
  for (const Mark& mark : clip.marks)
    if (mark.name == "impact") from = frame_at(clip, mark.time_s);
  const std::vector<double> way = mean_way(points);
  const double half = 0.5 * (way[from] + way.back());
  return static_cast<int>(std::lower_bound(way.begin() + from, way.end() - 1, half) - way.begin());
}

std::vector<double> mean_speeds(const Clip& clip, const std::vector<std::vector<Vec3>>& points) {
  const std::vector<double> way = mean_way(points);
  std::vector<double> speeds(way.size(), 0.0);
  for (std::size_t frame = 0; frame < way.size(); ++frame) {
    const std::size_t before = frame > 1 ? frame - 2 : 0;
    const std::size_t after = std::min(frame + 1, way.size() - 1);
    if (after > before)
      speeds[frame] = (way[after] - way[before]) * clip.fps / static_cast<double>(after - before);
  }
  return speeds;
}

std::vector<Moment> choose_moments(const Clip& original, const std::vector<std::vector<Vec3>>& points,
                                   int count) {
  Clip clip = with_rest_at_end(original, points);
  mark_peak_speed(clip, points);
  std::vector<int> fixed;
  for (const int frame : wanted_frames(clip))
    if (static_cast<int>(fixed.size()) < count && std::find(fixed.begin(), fixed.end(), frame) == fixed.end())
      fixed.push_back(frame);
  std::sort(fixed.begin(), fixed.end());

  const std::vector<double> way = travelled(clip, points);
  const std::vector<int> pieces = pieces_per_stretch(fixed, way, count - static_cast<int>(fixed.size()));
  std::vector<int> frames{fixed.front()};
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    divide(frames, way, fixed[i], fixed[i + 1], pieces[i]);
    frames.push_back(fixed[i + 1]);
  }

  std::vector<Moment> moments;
  for (const int frame : frames) moments.push_back({frame, phase_at(clip, frame)});
  return moments;
}

}  // namespace ukemi
