// Key reduction: every curve gets keys within a tolerance of its own; then forward kinematics at every frame
// makes curves exact where a node is too far off, and removes keys while every node stays near enough.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "export/export.h"
#include "export/key_curve.h"

namespace ukemi {
namespace {

// A quantity that moves no node by more than this is still.
constexpr double kStillM = 1e-7;
// A node without children stands for skin that reaches as far as its bone is long, at most this; a mesh or an
// end in the place of the bone, as far as that bone.
constexpr double kTipMaxM = 0.2;
constexpr double kTipMinM = 0.01;
constexpr double kSamePlaceM = 1e-4;
// Share of the bound that one curve may use up alone. Errors of a chain's joints rarely point the same way.
// Of 0.3 to 1, tried on falls and flinches, all leave as many keys within 2 %.
constexpr double kShare = 0.5;
constexpr int kRemovalPasses = 3;
// Rounded rotations may break the bound: it is tightened, and at last every key is kept.
constexpr int kAttempts = 5;

KeyValue value_of(const LocalTransform& local, TrackPath path) {
  if (path == TrackPath::rotation) return local.rotation.normalized().coeffs();
  const Vec3& v = path == TrackPath::translation ? local.translation : local.scale;
  return {v.x(), v.y(), v.z(), 0.0};
}

void set_value(LocalTransform& local, TrackPath path, const KeyValue& value) {
  if (path == TrackPath::rotation)
    local.rotation = Quat(value).normalized();
  else
    (path == TrackPath::translation ? local.translation : local.scale) = value.head<3>();
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
  const Affine& world_from_file() const { return world_from_file_; }
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
  /// To the next node above in another place.
  double bone_length_m(const std::vector<Affine>& nodes, int node) const {
    for (int above = skeleton_.nodes[node].parent; above >= 0; above = skeleton_.nodes[above].parent)
      if (const double length = (nodes[node].translation() - nodes[above].translation()).norm();
          length > kSamePlaceM)
        return length;
    return kTipMaxM;
  }
  void measure(const Pose& pose) {
    const std::vector<Affine> nodes = world(pose);
    const auto below = skeleton_.children();
    for (int i = 0; i < skeleton_.size(); ++i) {
      const int parent = skeleton_.nodes[i].parent;
      const Affine& above = parent < 0 ? world_from_file_ : nodes[parent];
      metres_per_unit_[i] = std::max(metres_per_unit_[i], above.linear().norm() / std::sqrt(3.0));
      double tip_m = 0.0;
      if (below[i].empty()) {
        tip_m = std::clamp(bone_length_m(nodes, i), kTipMinM, kTipMaxM);
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

/// The quantity over the clip, with a key at every frame; rotations in continuous signs.
KeyCurve curve_of(const Clip& clip, int node, TrackPath path) {
  KeyCurve curve{node, path, {}, {}, {}, {}};
  curve.wanted.reserve(clip.frames.size());
  for (const Pose& pose : clip.frames) {
    KeyValue value = value_of(pose[node], path);
    if (path == TrackPath::rotation && !curve.wanted.empty() && value.dot(curve.wanted.back()) < 0)
      value = -value;
    curve.wanted.push_back(value);
  }
  curve.reduced = curve.wanted;
  curve.values = curve.wanted;
  curve.keys.resize(curve.wanted.size());
  std::iota(curve.keys.begin(), curve.keys.end(), 0);
  return curve;
}

bool is_still(const KeyCurve& curve, double reach_m) {
  return std::all_of(curve.wanted.begin(), curve.wanted.end(), [&](const KeyValue& v) {
    return reach_m * distance(curve.path, v, curve.wanted.front()) <= kStillM;
  });
}

bool is_rest(const KeyCurve& curve, const LocalTransform& rest, double reach_m) {
  KeyValue value = value_of(rest, curve.path);
  if (curve.path == TrackPath::rotation && value.dot(curve.wanted.front()) < 0) value = -value;
  return reach_m * distance(curve.path, value, curve.wanted.front()) <= kStillM;
}

void keep_one_key(KeyCurve& curve) {
  curve.keys = {0};
  curve.values.resize(1);
  std::fill(curve.reduced.begin(), curve.reduced.end(), curve.values.front());
}

/// Curves of what moves or rests elsewhere, with all keys or a single one.
std::vector<KeyCurve> curves_of(const Skeleton& skeleton, const Clip& clip, const Rig& rig) {
  std::vector<KeyCurve> curves;
  for (int node = 0; node < skeleton.size(); ++node) {
    for (const TrackPath path : {TrackPath::translation, TrackPath::rotation, TrackPath::scale}) {
      KeyCurve curve = curve_of(clip, node, path);
      const double reach_m = rig.reach_m(node, path);
      const bool still = is_still(curve, reach_m);
      if (still && is_rest(curve, skeleton.nodes[node].rest, reach_m)) continue;
      if (still) keep_one_key(curve);
      curves.push_back(std::move(curve));
    }
  }
  return curves;
}

/// The reduced clip against the whole one, node by node and frame by frame.
class Reduction {
 public:
  Reduction(const Skeleton& skeleton, const Clip& clip, const Rig& rig, std::vector<KeyCurve>& curves)
      : skeleton_(skeleton), rig_(rig), curves_(curves), below_(skeleton.nodes.size()) {
    for (const int node : skeleton.order)
      for (int above = node; above >= 0; above = skeleton.nodes[above].parent) below_[above].push_back(node);
    by_node_.resize(skeleton.nodes.size());
    for (std::size_t i = 0; i < curves.size(); ++i) by_node_[curves[i].node].push_back(i);
    for (const Pose& pose : clip.frames) {
      wanted_.push_back(rig.world(pose));
      local_.push_back(pose);
    }
    world_ = wanted_;
    error_m_.assign(clip.frames.size(), std::vector<double>(skeleton.nodes.size(), 0.0));
    pinned_ = {0, static_cast<int>(clip.frames.size()) - 1};
    for (const Mark& mark : clip.marks)
      if (mark.name == "impact") pinned_.push_back(static_cast<int>(std::lround(mark.time_s * clip.fps)));
    std::sort(pinned_.begin(), pinned_.end());
    pinned_.erase(std::unique(pinned_.begin(), pinned_.end()), pinned_.end());
  }

  void run(double bound_m, const ExactRotations& exact) {
    bound_m_ = bound_m;
    for (KeyCurve& curve : curves_) {
      tolerance_.push_back(kShare * bound_m_ / std::max(rig_.reach_m(curve.node, curve.path), 1e-12));
      if (curve.is_single()) continue;
      choose_keys(curve, tolerance_.back(), pinned_);
      fit_values(curve, tolerance_.back(), 0, static_cast<int>(curve.keys.size()) - 1, pinned_);
    }
    measure_all();
    while (repair()) {
    }
    for (int pass = 0; pass < kRemovalPasses && remove_keys(); ++pass) {
    }
    measure_all();
    while (exact && turn_exactly(exact))
      while (repair()) {
      }
  }

  /// Of all nodes and frames.
  double error_m() {
    measure_all();
    double largest = 0.0;
    for (const auto& frame : error_m_)
      for (const double error : frame) largest = std::max(largest, error);
    return largest;
  }

 private:
  int frames() const { return static_cast<int>(wanted_.size()); }

  /// Takes a curve's value at a frame over and moves what hangs on it. False, and not all is moved, once a
  /// node is too far off and `limit` is given.
  bool move(const KeyCurve& curve, int f, double limit_m = std::numeric_limits<double>::infinity()) {
    set_value(local_[f][curve.node], curve.path, curve.reduced[f]);
    for (const int node : below_[curve.node]) {
      measure(f, node);
      if (error_m_[f][node] > limit_m) return false;
    }
    return true;
  }
  void measure_all() {
    for (int f = 0; f < frames(); ++f) {
      for (const KeyCurve& curve : curves_) set_value(local_[f][curve.node], curve.path, curve.reduced[f]);
      for (const int node : skeleton_.order) measure(f, node);
    }
  }
  void measure(int f, int node) {
    const int parent = skeleton_.nodes[node].parent;
    world_[f][node] = (parent < 0 ? rig_.world_from_file() : world_[f][parent]) * local_[f][node].affine();
    error_m_[f][node] = rig_.distance_m(node, world_[f][node], wanted_[f][node]);
  }

  // ---- keys put back

  /// Makes curves exact, the largest contribution first, until no node is too far off. True where that moved
  /// frames that had been looked at.
  bool repair() {
    int mended = 0;
    for (int f = 0; f < frames(); ++f) {
      const std::vector<double>& errors = error_m_[f];
      for (auto worst = std::max_element(errors.begin(), errors.end());
           *worst > bound_m_ && mend(f, static_cast<int>(worst - errors.begin()));
           worst = std::max_element(errors.begin(), errors.end()))
        ++mended;
    }
    return mended > 0;
  }
  /// Makes the curve exact that moves the worst node most; false where all above it are.
  bool mend(int f, int worst) {
    KeyCurve* found = nullptr;
    double largest = 1e-9 * bound_m_;
    for (int node = worst; node >= 0; node = skeleton_.nodes[node].parent) {
      for (const std::size_t i : by_node_[node]) {
        KeyCurve& curve = curves_[i];
        if (curve.is_single()) continue;
        const double share =
            lever_m(curve, worst, f) * distance(curve.path, curve.reduced[f], curve.wanted[f]);
        if (share <= largest) continue;
        largest = share;
        found = &curve;
      }
    }
    if (found == nullptr) return false;
    make_exact(*found, f);
    return true;
  }
  double lever_m(const KeyCurve& curve, int worst, int f) const {
    if (curve.path == TrackPath::translation) return rig_.reach_m(curve.node, curve.path);
    return std::max((wanted_[f][worst].translation() - wanted_[f][curve.node].translation()).norm(),
                    kTipMinM);
  }
  void make_exact(KeyCurve& curve, int f) {
    const auto at = std::lower_bound(curve.keys.begin(), curve.keys.end(), f);
    const int k = static_cast<int>(at - curve.keys.begin());
    if (*at == f) {
      curve.values[k] = curve.wanted[f];
    } else {
      curve.keys.insert(at, f);
      curve.values.insert(curve.values.begin() + k, curve.wanted[f]);
    }
    const int first = std::max(k - 1, 0);
    const int last = std::min(k + 1, static_cast<int>(curve.keys.size()) - 1);
    interpolate(curve, first, last);
    for (int g = curve.keys[first]; g <= curve.keys[last]; ++g) move(curve, g);
  }

  /// Puts back the keys of rotations that have to be exact; false where all are.
  bool turn_exactly(const ExactRotations& exact) {
    constexpr double kSame = 1e-9;
    bool mended = false;
    for (int f = 0; f < frames(); ++f)
      for (const int node : exact(static_cast<std::size_t>(f), local_[f]))
        for (const std::size_t i : by_node_[node]) {
          KeyCurve& curve = curves_[i];
          if (curve.path != TrackPath::rotation || curve.is_single() ||
              distance(curve.path, curve.reduced[f], curve.wanted[f]) <= kSame)
            continue;
          make_exact(curve, f);
          mended = true;
        }
    return mended;
  }

  // ---- keys taken away

  bool remove_keys() {
    bool removed = false;
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      for (int k = 1; k + 1 < static_cast<int>(curves_[i].keys.size());) {
        if (!std::binary_search(pinned_.begin(), pinned_.end(), curves_[i].keys[k]) && remove_key(i, k))
          removed = true;
        else
          ++k;
      }
    }
    return removed;
  }
  bool remove_key(std::size_t i, int k) {
    KeyCurve& curve = curves_[i];
    if (!is_short_way(curve.path, curve.values[k - 1], curve.values[k + 1])) return false;
    const KeyCurve before = curve;
    const int removed = curve.keys[k];
    curve.keys.erase(curve.keys.begin() + k);
    curve.values.erase(curve.values.begin() + k);
    interpolate(curve, k - 1, k);
    fit_values(curve, tolerance_[i], k - 1, k, pinned_);
    std::vector<int> changed(before.keys[std::min<std::size_t>(k + 2, before.keys.size() - 1)] -
                             before.keys[std::max(k - 2, 0)] + 1);
    std::iota(changed.begin(), changed.end(), before.keys[std::max(k - 2, 0)]);
    const auto distance_to_removed = [&](int f) { return std::abs(f - removed); };
    std::stable_sort(changed.begin(), changed.end(),
                     [&](int a, int b) { return distance_to_removed(a) < distance_to_removed(b); });
    for (auto f = changed.begin(); f != changed.end(); ++f) {
      if (move(curve, *f, bound_m_)) continue;
      curve = before;
      std::for_each(changed.begin(), f + 1, [&](int g) { move(curve, g); });
      return false;
    }
    return true;
  }

  const Skeleton& skeleton_;
  const Rig& rig_;
  std::vector<KeyCurve>& curves_;
  double bound_m_ = 0.0;
  std::vector<int> pinned_;
  std::vector<std::vector<int>> below_;            // the node and what hangs on it, parents first
  std::vector<std::vector<std::size_t>> by_node_;  // curves
  std::vector<double> tolerance_;                  // per curve
  std::vector<std::vector<Affine>> wanted_, world_;
  std::vector<Pose> local_;
  std::vector<std::vector<double>> error_m_;  // per frame and node
};

Track track_of(const KeyCurve& curve, double fps) {
  Track track{curve.node, curve.path, Interpolation::linear, {}, {}};
  const int width = curve.path == TrackPath::rotation ? 4 : 3;
  for (std::size_t k = 0; k < curve.keys.size(); ++k) {
    track.times.push_back(curve.keys[k] / fps);
    for (int i = 0; i < width; ++i) track.values.push_back(curve.values[k][i]);
  }
  return track;
}

/// Rotations as glTF's normalised signed shorts hold them.
void round_rotations(std::vector<KeyCurve>& curves) {
  for (KeyCurve& curve : curves) {
    if (curve.path != TrackPath::rotation) continue;
    for (KeyValue& value : curve.values) value = (value * 32767.0).array().round().matrix() / 32767.0;
    interpolate(curve, 0, static_cast<int>(curve.keys.size()) - 1);
    if (curve.is_single()) std::fill(curve.reduced.begin(), curve.reduced.end(), curve.values.front());
  }
}

/// A clip in which nothing moves still lasts as long as it does: its first curve gets a key at the end.
void keep_duration(std::vector<KeyCurve>& curves, const Skeleton& skeleton, const Clip& clip) {
  const int last = static_cast<int>(clip.frames.size()) - 1;
  const auto lasts = [&](const KeyCurve& curve) { return curve.keys.back() == last; };
  if (skeleton.order.empty() || std::any_of(curves.begin(), curves.end(), lasts)) return;
  if (curves.empty()) {
    curves.push_back(curve_of(clip, skeleton.order.front(), TrackPath::translation));
    keep_one_key(curves.back());
  }
  if (last == 0) return;
  curves.front().keys.push_back(last);
  curves.front().values.push_back(curves.front().values.front());
}

/// Gives translation and rotation of `joints` a key at either end where they have none or a single one: what
/// plays them need not know the rest pose.
void key_both_ends(const std::vector<int>& joints, const Clip& clip, std::vector<KeyCurve>& curves) {
  const int last = static_cast<int>(clip.frames.size()) - 1;
  for (const int node : joints)
    for (const TrackPath path : {TrackPath::translation, TrackPath::rotation}) {
      const auto of_joint = [&](const KeyCurve& curve) { return curve.node == node && curve.path == path; };
      auto curve = std::find_if(curves.begin(), curves.end(), of_joint);
      if (curve == curves.end()) {
        curve = curves.insert(curve, curve_of(clip, node, path));
        keep_one_key(*curve);
      }
      if (!curve->is_single() || last == 0) continue;
      curve->keys.push_back(last);
      curve->values.push_back(curve->values.front());
    }
}

}  // namespace

ReducedClip reduce_keys(const Skeleton& skeleton, const Clip& clip, const Similarity& world_from_file,
                        const KeyReduction& settings, const ExactRotations& exact) {
  ReducedClip result{clip.name, {}, 0, 0.0, clip.marks, settings.short_rotations};
  if (clip.frames.empty()) return result;
  const Rig rig(skeleton, clip, world_from_file);
  const std::vector<KeyCurve> all = curves_of(skeleton, clip, rig);
  std::vector<KeyCurve> curves;
  double bound_m = settings.tolerance_m;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    curves = all;
    Reduction reduction(skeleton, clip, rig, curves);
    if (settings.enabled && bound_m > 0.0) reduction.run(bound_m, exact);
    if (settings.short_rotations) round_rotations(curves);
    result.error_m = reduction.error_m();
    if (!settings.enabled || result.error_m <= settings.tolerance_m || bound_m <= 0.0) break;
    bound_m = attempt + 2 < kAttempts ? bound_m - 1.1 * (result.error_m - settings.tolerance_m) : 0.0;
  }
  key_both_ends(settings.joints, clip, curves);
  keep_duration(curves, skeleton, clip);
  for (const KeyCurve& curve : curves) {
    result.tracks.push_back(track_of(curve, clip.fps));
    result.keys += curve.keys.size();
  }
  return result;
}

}  // namespace ukemi
