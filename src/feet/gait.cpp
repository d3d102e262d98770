#include "feet/gait.h"

#include <algorithm>
#include <cmath>

#include "base/quantile.h"
#include "body/centre_of_mass.h"
#include "body/on_ground.h"

namespace ukemi {
namespace {

constexpr double kDown = 0.045;      // of the leg: a sole whose lowest corner is lower may stand
constexpr double kStill = 0.45;      // of the speed of the gait, and
constexpr double kStill_m_s = 0.15;  // faster by that: a sole that moves more does not stand
constexpr double kShortestGap_s = 0.06, kShortestStand_s = 0.07;
constexpr double kFloor = 0.3;  // of the moments of a gait a sole is lower
constexpr double kSinks_s = 0.15;
constexpr double kSettled_s = 0.03;  // after the landing a sole has its place
constexpr int kSmooth = 3;           // frames to either side

std::vector<Vec3> smoothed(const std::vector<Vec3>& values) {
  const int last = static_cast<int>(values.size()) - 1;
  std::vector<Vec3> result;
  for (int i = 0; i <= last; ++i) {
    const int reach = std::min({kSmooth, i, last - i});
    Vec3 sum = Vec3::Zero();
    for (int k = i - reach; k <= i + reach; ++k) sum += values[k];
    result.push_back(sum / (2 * reach + 1));
  }
  return result;
}

std::vector<Vec3> slopes(const std::vector<Vec3>& values, double step_s) {
  const int last = static_cast<int>(values.size()) - 1;
  std::vector<Vec3> result;
  for (int i = 0; i <= last; ++i) {
    const int a = std::max(0, i - 1), b = std::min(last, i + 1);
    result.push_back((values[b] - values[a]) / (step_s * (b - a)));
  }
  return result;
}

/// Runs of `down`, gaps closed and short ones dropped: first and last index.
std::vector<std::pair<int, int>> runs_of(std::vector<bool> down, double step_s) {
  const int count = static_cast<int>(down.size());
  std::vector<std::pair<int, int>> runs;
  for (int i = 0; i < count; ++i) {
    if (!down[i]) continue;
    if (!runs.empty() && (i - runs.back().second) * step_s <= kShortestGap_s)
      runs.back().second = i;
    else
      runs.emplace_back(i, i);
  }
  std::erase_if(runs, [&](const auto& run) {
    const bool cut = run.first == 0 || run.second == count - 1;
    return !cut && (run.second - run.first) * step_s < kShortestStand_s;
  });
  return runs;
}

}  // namespace

Gait::Gait(const ArticulatedBody& body, const PerSide<Leg>& legs, const std::vector<BodyPose>& frames,
           double step_s, double gravity)
    : frames_(frames), step_s_(step_s) {
  stand_on_floor(legs);
  for (const BodyPose& frame : frames_) com_.push_back(centre_of_mass(body, frame));
  com_ = smoothed(com_);
  velocity_ = slopes(com_, step_s);
  acceleration_ = smoothed(slopes(velocity_, step_s));
  speed_ = on_ground(com_.back() - com_.front()).norm() / end_s();
  for (const BodySide side : kSides) stands_[index(side)] = stands_of(legs[index(side)], gravity);
}

/// Captured and made gaits float by some centimetres: their soles are brought to the floor, after a moment.
void Gait::stand_on_floor(const PerSide<Leg>& legs) {
  std::vector<double> heights;
  for (const BodyPose& frame : frames_) {
    double lowest = 1e9;
    for (const Leg& leg : legs)
      for (const Vec3& corner : leg.sole) lowest = std::min(lowest, (frame[index(leg.foot)] * corner).y());
    heights.push_back(lowest);
  }
  const double gap = std::max(0.0, quantile(heights, kFloor));
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const double share = min_jerk(step_s_ * static_cast<double>(i) / kSinks_s);
    for (Rigid& segment : frames_[i]) segment.translation.y() -= share * gap;
  }
}

std::vector<Stand> Gait::stands_of(const Leg& leg, double gravity) const {
  const int count = static_cast<int>(frames_.size());
  const auto corner = [&](int frame, int i) { return frames_[frame][index(leg.foot)] * leg.sole[i]; };
  std::vector<bool> down;
  for (int f = 0; f < count; ++f) {
    int lowest = 0;
    for (int i = 1; i < 4; ++i)
      if (corner(f, i).y() < corner(f, lowest).y()) lowest = i;
    const int a = std::max(0, f - 1), b = std::min(count - 1, f + 1);
    const double speed = on_ground(corner(b, lowest) - corner(a, lowest)).norm() / (step_s_ * (b - a));
    down.push_back(corner(f, lowest).y() < kDown * leg.length_m() && speed < kStill * speed_ + kStill_m_s);
  }
  std::vector<Stand> stands;
  for (const auto& [first, last] : runs_of(down, step_s_)) {
    Stand stand;
    stand.from_s = first * step_s_;
    stand.until_s = last == count - 1 ? 1e9 : last * step_s_;
    const double settled_s = std::min(stand.from_s + kSettled_s, end_s());
    stand.sole = on_ground(pose(settled_s)[index(leg.foot)] * leg.sole_middle);
    const Vec3 c = com(stand.from_s);
    const double rate = std::sqrt(gravity / std::max(c.y(), 0.1));
    stand.catch_at = on_ground(c) + on_ground(velocity(stand.from_s)) / rate - stand.sole;
    stands.push_back(stand);
  }
  return stands;
}

BodyPose Gait::pose(double time_s) const {
  const double at = std::clamp(time_s / step_s_, 0.0, static_cast<double>(frames_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(at), frames_.size() - 2);
  const double share = at - static_cast<double>(i);
  BodyPose pose = frames_[i];
  for (int s = 0; s < kSegmentCount; ++s) {
    const Rigid& next = frames_[i + 1][s];
    pose[s] = {pose[s].rotation.slerp(share, next.rotation),
               pose[s].translation + share * (next.translation - pose[s].translation)};
  }
  return pose;
}

Vec3 Gait::at(const std::vector<Vec3>& values, double time_s) const {
  const double at = std::clamp(time_s / step_s_, 0.0, static_cast<double>(values.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(at), values.size() - 2);
  return values[i] + (at - static_cast<double>(i)) * (values[i + 1] - values[i]);
}

}  // namespace ukemi
