// Key reduction: the longest pieces that stay within a joint's own tolerance, then a check of the whole
// reduced clip by forward kinematics, which puts keys back where the error of a node's world position is too
// large.
#include <algorithm>
#include <cmath>
#include <utility>

#include "export/export.h"

namespace ukemi {
namespace {

using Value = Eigen::Vector4d;  // x y z w of a rotation; x y z 0 of a translation or scale

// A quantity that moves no node by more than this is still.
constexpr double kStillM = 1e-7;
// Share of the tolerance that one joint may use up alone before the check. Errors of a chain's joints rarely
// point the same way. Of 0.3 to 3, tried on falls and walks, this leaves the fewest keys after the check.
constexpr double kShare = 1.0;
// A node without children stands for skin that reaches as far as its bone is long, at most this.
constexpr double kTipMaxM = 0.2;
constexpr double kTipMinM = 0.01;

struct Curve {
  int node = -1;
  TrackPath path = TrackPath::rotation;
  double reach_m = 0.0;        // distance that one unit (radian, file unit, 1) moves the farthest node
  std::vector<Value> wanted;   // one per frame
  std::vector<Value> reduced;  // one per frame: the keys interpolated
  std::vector<int> keys;       // frames, ascending
};

Value value_of(const LocalTransform& local, TrackPath path) {
  if (path == TrackPath::rotation) return local.rotation.normalized().coeffs();
  const Vec3& v = path == TrackPath::translation ? local.translation : local.scale;
  return {v.x(), v.y(), v.z(), 0.0};
}

void set_value(LocalTransform& local, TrackPath path, const Value& value) {
  if (path == TrackPath::rotation)
    local.rotation = Quat(value).normalized();
  else
    (path == TrackPath::translation ? local.translation : local.scale) = value.head<3>();
}

/// Radians, file units or 1. The chord of two unit quaternions is half the angle to third order.
double distance(TrackPath path, const Value& a, const Value& b) {
  return (path == TrackPath::rotation ? 2.0 : 1.0) * (a - b).norm();
}

/// Values at equal steps from a to b, exclusive of both: x(k+1) = c x(k) - x(k-1) holds for a line with c = 2
/// and for a great arc of unit quaternions with c = 2 cos(step).
template <typename Visit>
bool each_between(TrackPath path, const Value& a, const Value& b, int steps, Visit visit) {
  double c = 2.0;
  Value previous = a;
  Value current = a + (b - a) / steps;
  if (path == TrackPath::rotation) {
    const double half = std::atan2((a - b).norm(), (a + b).norm());  // of the arc
    if (half > kPi / 4) return false;  // a viewer would take the other way round
    const double arc = 2.0 * half;
    c = 2.0 * std::cos(arc / steps);
    if (arc > 1e-8) current = (std::sin(arc - arc / steps) * a + std::sin(arc / steps) * b) / std::sin(arc);
  }
  for (int k = 1; k < steps; ++k) {
    if (!visit(k, current)) return false;
    const Value next = c * current - previous;
    previous = current;
    current = next;
  }
  return true;
}

bool fits(const Curve& curve, int from, int to, double tolerance) {
  return each_between(
      curve.path, curve.wanted[from], curve.wanted[to], to - from,
      [&](int k, const Value& v) { return distance(curve.path, v, curve.wanted[from + k]) <= tolerance; });
}

/// Last frame that a piece from `from` may reach: doubled until it fails, then bisected.
int longest_piece(const Curve& curve, int from, double tolerance) {
  const int last = static_cast<int>(curve.wanted.size()) - 1;
  int good = from + 1;
  int bad = last + 1;
  for (int length = 2; good < last; length *= 2) {
    const int to = std::min(from + length, last);
    if (!fits(curve, from, to, tolerance)) {
      bad = to;
      break;
    }
    good = to;
  }
  while (bad - good > 1) {
    const int middle = (good + bad) / 2;
    (fits(curve, from, middle, tolerance) ? good : bad) = middle;
  }
  return good;
}

void interpolate(Curve& curve, int from, int to) {
  curve.reduced[from] = curve.wanted[from];
  curve.reduced[to] = curve.wanted[to];
  each_between(curve.path, curve.wanted[from], curve.wanted[to], to - from, [&](int k, const Value& v) {
    curve.reduced[from + k] = v;
    return true;
  });
}

void choose_keys(Curve& curve, double tolerance_m) {
  const int last = static_cast<int>(curve.wanted.size()) - 1;
  const double tolerance = kShare * tolerance_m / std::max(curve.reach_m, 1e-12);
  curve.keys = {0};
  for (int from = 0; from < last; from = curve.keys.back()) {
    curve.keys.push_back(longest_piece(curve, from, tolerance));
    interpolate(curve, from, curve.keys.back());
  }
}

/// The skeleton in world metres, and how far its nodes reach.
class Rig {
 public:
  Rig(const Skeleton& skeleton, const Clip& clip, const Similarity& world_from_file)
      : skeleton_(skeleton),
        world_from_file_(world_from_file.affine()),
        tip_(skeleton.nodes.size(), 0.0),
        reach_m_(skeleton.nodes.size(), 0.0),
        metres_per_unit_(skeleton.nodes.size(), 0.0) {
    const std::size_t last = clip.frames.size() - 1;
    for (const std::size_t frame : {std::size_t{0}, last / 2, last}) measure(clip.frames[frame]);
  }

  std::vector<Affine> world(const Pose& pose) const {
    std::vector<Affine> result(pose.size());
    for (const int i : skeleton_.order) {
      const int parent = skeleton_.nodes[i].parent;
      result[i] = (parent < 0 ? world_from_file_ : result[parent]) * pose[i].affine();
    }
    return result;
  }
  double reach_m(int node, TrackPath path) const {
    return path == TrackPath::translation ? metres_per_unit_[node] : reach_m_[node];
  }
  /// Distance of a node, and of its tip where it has no children, between two poses. The Frobenius norm of
  /// the difference of two rotations is sqrt(2) times the angle, for small angles.
  double distance_m(int node, const Affine& a, const Affine& b) const {
    const double moved = (a.translation() - b.translation()).norm();
    if (tip_[node] == 0.0) return moved;
    return moved + tip_[node] * (a.linear() - b.linear()).norm() / std::sqrt(2.0);
  }

 private:
  void measure(const Pose& pose) {
    const std::vector<Affine> nodes = world(pose);
    const auto below = skeleton_.children();
    for (int i = 0; i < skeleton_.size(); ++i) {
      const int parent = skeleton_.nodes[i].parent;
      const Affine& above = parent < 0 ? world_from_file_ : nodes[parent];
      metres_per_unit_[i] = std::max(metres_per_unit_[i], above.linear().norm() / std::sqrt(3.0));
      double tip_m = 0.0;
      if (below[i].empty()) {
        const double bone_m = parent < 0 ? kTipMaxM : (nodes[i].translation() - above.translation()).norm();
        tip_m = std::clamp(bone_m, kTipMinM, kTipMaxM);
        const double scale = nodes[i].linear().norm() / std::sqrt(3.0);
        tip_[i] = scale > 0.0 ? tip_m / scale : 0.0;
      }
      for (int a = i; a >= 0; a = skeleton_.nodes[a].parent)
        reach_m_[a] = std::max(reach_m_[a], (nodes[i].translation() - nodes[a].translation()).norm() + tip_m);
    }
  }

  const Skeleton& skeleton_;
  Affine world_from_file_;
  std::vector<double> tip_;              // in the node's own units; 0: has children
  std::vector<double> reach_m_;          // to the farthest node below
  std::vector<double> metres_per_unit_;  // of the node's translation
};

/// The quantity over the clip; rotations in continuous signs.
Curve curve_of(const Clip& clip, int node, TrackPath path, double reach_m) {
  Curve curve{node, path, reach_m, {}, {}, {}};
  curve.wanted.reserve(clip.frames.size());
  for (const Pose& pose : clip.frames) {
    Value value = value_of(pose[node], path);
    if (path == TrackPath::rotation && !curve.wanted.empty() && value.dot(curve.wanted.back()) < 0)
      value = -value;
    curve.wanted.push_back(value);
  }
  curve.reduced = curve.wanted;
  return curve;
}

bool is_still(const Curve& curve) {
  return std::all_of(curve.wanted.begin(), curve.wanted.end(), [&](const Value& v) {
    return curve.reach_m * distance(curve.path, v, curve.wanted.front()) <= kStillM;
  });
}

bool is_rest(const Curve& curve, const LocalTransform& rest) {
  Value value = value_of(rest, curve.path);
  if (curve.path == TrackPath::rotation && value.dot(curve.wanted.front()) < 0) value = -value;
  return curve.reach_m * distance(curve.path, value, curve.wanted.front()) <= kStillM;
}

/// Curves of what moves or rests elsewhere, with all keys or a single one.
std::vector<Curve> curves_of(const Skeleton& skeleton, const Clip& clip, const Rig& rig) {
  std::vector<Curve> curves;
  for (int node = 0; node < skeleton.size(); ++node) {
    for (const TrackPath path : {TrackPath::translation, TrackPath::rotation, TrackPath::scale}) {
      Curve curve = curve_of(clip, node, path, rig.reach_m(node, path));
      const bool still = is_still(curve);
      if (still && is_rest(curve, skeleton.nodes[node].rest)) continue;
      curve.keys.resize(still ? 1 : clip.frames.size());
      for (std::size_t i = 0; i < curve.keys.size(); ++i) curve.keys[i] = static_cast<int>(i);
      curves.push_back(std::move(curve));
    }
  }
  return curves;
}

/// The reduced clip against the whole one, frame by frame.
class Check {
 public:
  Check(const Skeleton& skeleton, const Clip& clip, const Rig& rig, std::vector<Curve>& curves)
      : skeleton_(skeleton),
        rig_(rig),
        curves_(curves),
        pose_(rest_pose(skeleton)),
        error_m_(clip.frames.size()) {
    wanted_.reserve(clip.frames.size());
    for (const Pose& pose : clip.frames) wanted_.push_back(rig.world(pose));
    by_node_.resize(skeleton.nodes.size());
    for (std::size_t i = 0; i < curves.size(); ++i) by_node_[curves[i].node].push_back(i);
    worst_.resize(clip.frames.size(), -1);
    dirty_.assign(clip.frames.size(), true);
  }

  /// Puts keys back until no node is further off than the tolerance, or no key is left to put back.
  void repair(double tolerance_m) {
    do measure();
    while (add_keys(tolerance_m));
  }
  double error_m() {
    measure();
    return error_m_.empty() ? 0.0 : *std::max_element(error_m_.begin(), error_m_.end());
  }

 private:
  void measure() {
    for (std::size_t frame = 0; frame < wanted_.size(); ++frame) {
      if (!dirty_[frame]) continue;
      dirty_[frame] = false;
      for (const Curve& curve : curves_)
        set_value(pose_[curve.node], curve.path, curve.reduced[curve.keys.size() == 1 ? 0 : frame]);
      const std::vector<Affine> world = rig_.world(pose_);
      error_m_[frame] = 0.0;
      for (int node = 0; node < skeleton_.size(); ++node) {
        const double error = rig_.distance_m(node, world[node], wanted_[frame][node]);
        if (error < error_m_[frame]) continue;
        error_m_[frame] = error;
        worst_[frame] = node;
      }
    }
  }

  /// The curve above the worst node that contributes most at this frame; none where all have a key there.
  Curve* culprit(int frame) {
    Curve* found = nullptr;
    double largest = 0.0;
    for (int node = worst_[frame]; node >= 0; node = skeleton_.nodes[node].parent) {
      for (const std::size_t i : by_node_[node]) {
        Curve& curve = curves_[i];
        const double share =
            lever_m(curve, frame) * distance(curve.path, curve.reduced[frame], curve.wanted[frame]);
        if (share <= largest || curve.keys.size() == 1) continue;
        if (std::binary_search(curve.keys.begin(), curve.keys.end(), frame)) continue;
        largest = share;
        found = &curve;
      }
    }
    return found;
  }
  double lever_m(const Curve& curve, int frame) const {
    if (curve.path == TrackPath::translation) return curve.reach_m;
    const std::vector<Affine>& world = wanted_[frame];
    return std::max((world[worst_[frame]].translation() - world[curve.node].translation()).norm(), kTipMinM);
  }

  /// One key for each piece that is to blame, at its worst frame.
  bool add_keys(double tolerance_m) {
    std::vector<std::pair<Curve*, int>> wanted;  // curve, frame; the worst frame first
    std::vector<int> frames;
    for (int frame = 0; frame < static_cast<int>(wanted_.size()); ++frame)
      if (error_m_[frame] > tolerance_m) frames.push_back(frame);
    std::stable_sort(frames.begin(), frames.end(), [&](int a, int b) { return error_m_[a] > error_m_[b]; });
    for (const int frame : frames)
      if (Curve* curve = culprit(frame)) wanted.emplace_back(curve, frame);
    bool added = false;
    for (const auto& [curve, frame] : wanted) added |= add_key(*curve, frame);
    return added;
  }
  /// False where this pass has touched the piece already.
  bool add_key(Curve& curve, int frame) {
    const auto after = std::upper_bound(curve.keys.begin(), curve.keys.end(), frame);
    const int to = *after;
    const int from = *(after - 1);
    if (from == frame || dirty_[frame]) return false;
    curve.keys.insert(after, frame);
    interpolate(curve, from, frame);
    interpolate(curve, frame, to);
    std::fill(dirty_.begin() + from + 1, dirty_.begin() + to, true);
    return true;
  }

  const Skeleton& skeleton_;
  const Rig& rig_;
  std::vector<Curve>& curves_;
  Pose pose_;
  std::vector<std::vector<Affine>> wanted_;
  std::vector<std::vector<std::size_t>> by_node_;
  std::vector<double> error_m_;
  std::vector<int> worst_;
  std::vector<bool> dirty_;
};

Track track_of(const Curve& curve, double fps) {
  Track track{curve.node, curve.path, Interpolation::linear, {}, {}};
  const int width = curve.path == TrackPath::rotation ? 4 : 3;
  for (const int key : curve.keys) {
    track.times.push_back(key / fps);
    for (int i = 0; i < width; ++i) track.values.push_back(curve.wanted[key][i]);
  }
  return track;
}

/// A clip in which nothing moves still lasts as long as it does: its first curve gets a key at the end.
void keep_duration(std::vector<Curve>& curves, const Skeleton& skeleton, const Clip& clip) {
  const int last = static_cast<int>(clip.frames.size()) - 1;
  const auto lasts = [&](const Curve& curve) { return curve.keys.back() == last; };
  if (skeleton.order.empty() || std::any_of(curves.begin(), curves.end(), lasts)) return;
  if (curves.empty()) {
    curves.push_back(curve_of(clip, skeleton.order.front(), TrackPath::translation, 0.0));
    curves.back().keys = {0};
  }
  if (last > 0) curves.front().keys.push_back(last);
}

}  // namespace

ReducedClip reduce_keys(const Skeleton& skeleton, const Clip& clip, const Similarity& world_from_file,
                        const KeyReduction& settings) {
  ReducedClip result{clip.name, {}, 0, 0.0, clip.marks};
  if (clip.frames.empty()) return result;
  const Rig rig(skeleton, clip, world_from_file);
  std::vector<Curve> curves = curves_of(skeleton, clip, rig);
  if (settings.enabled)
    for (Curve& curve : curves)
      if (curve.keys.size() > 1) choose_keys(curve, settings.tolerance_m);
  Check check(skeleton, clip, rig, curves);
  if (settings.enabled) check.repair(settings.tolerance_m);
  result.error_m = check.error_m();
  keep_duration(curves, skeleton, clip);
  for (const Curve& curve : curves) {
    result.tracks.push_back(track_of(curve, clip.fps));
    result.keys += curve.keys.size();
  }
  return result;
}

}  // namespace ukemi
