#include "export/key_curve.h"

#include <algorithm>
#include <cmath>

namespace ukemi {
namespace {

constexpr int kFitRounds = 5;
constexpr double kLeastGrowth = 0.05;  // of a weight in a round
// A piece that bends one way lies half as far off once its keys are fitted.
constexpr double kSlack = 2.0;

/// Values at equal steps from a to b, exclusive of both: x(k+1) = c x(k) - x(k-1) holds for a line with c = 2
/// and for a great arc of unit quaternions with c = 2 cos(step). False once `visit` is.
template <typename Visit>
bool each_between(TrackPath path, const KeyValue& a, const KeyValue& b, int steps, Visit visit) {
  double c = 2.0;
  KeyValue previous = a;
  KeyValue current = a + (b - a) / steps;
  if (path == TrackPath::rotation) {
    const double half = std::atan2((a - b).norm(), (a + b).norm());  // of the arc
    const double arc = 2.0 * half;
    c = 2.0 * std::cos(arc / steps);
    if (arc > 1e-8) current = (std::sin(arc - arc / steps) * a + std::sin(arc / steps) * b) / std::sin(arc);
  }
  for (int k = 1; k < steps; ++k) {
    if (!visit(k, current)) return false;
    const KeyValue next = c * current - previous;
    previous = current;
    current = next;
  }
  return true;
}

/// Last frame that a piece from `from` may reach: doubled until it fails, then bisected.
template <typename Fits>
int longest_piece(int from, int last, Fits fits) {
  int good = from + 1;
  int bad = last + 1;
  for (int length = 2; good < last; length *= 2) {
    const int to = std::min(from + length, last);
    if (!fits(to)) {
      bad = to;
      break;
    }
    good = to;
  }
  while (bad - good > 1) {
    const int middle = (good + bad) / 2;
    (fits(middle) ? good : bad) = middle;
  }
  return good;
}

/// What takes `from` to `to`: a rotation vector in the turned axes, or a difference.
Vec3 difference(TrackPath path, const KeyValue& from, const KeyValue& to) {
  if (path != TrackPath::rotation) return (to - from).head<3>();
  const Quat turn = Quat(from).conjugate() * Quat(to);
  return (turn.w() < 0.0 ? -2.0 : 2.0) * turn.vec();
}

KeyValue moved(TrackPath path, const KeyValue& value, const Vec3& by) {
  if (path != TrackPath::rotation) return value + KeyValue(by.x(), by.y(), by.z(), 0.0);
  const Quat turned = Quat(value) * Quat(1.0, 0.5 * by.x(), 0.5 * by.y(), 0.5 * by.z());
  return turned.coeffs().normalized();
}

/// A frame between two keys, how far along it lies and what is missing there.
struct Sample {
  int piece = 0;  // of the fitted keys, 0 before the first of them
  double along = 0.0;
  Vec3 error = Vec3::Zero();
  double weight = 1.0;
};

/// Corrections of keys in a row that bring the weighted squares of the samples' errors down: a tridiagonal
/// system.
class Corrections {
 public:
  explicit Corrections(std::vector<bool> is_fixed)
      : is_fixed_(std::move(is_fixed)), at_(is_fixed_.size(), Vec3::Zero()) {}

  void solve(const std::vector<Sample>& samples) {
    const std::size_t n = at_.size();
    std::vector<double> diagonal(n, 1e-30), above(n, 0.0);
    std::vector<Vec3> right(n, Vec3::Zero());
    for (const Sample& s : samples) {
      const auto i = static_cast<std::size_t>(s.piece);
      diagonal[i] += s.weight * (1 - s.along) * (1 - s.along);
      right[i] += s.weight * (1 - s.along) * s.error;
      if (s.along == 0.0) continue;
      diagonal[i + 1] += s.weight * s.along * s.along;
      above[i] += s.weight * s.along * (1 - s.along);
      right[i + 1] += s.weight * s.along * s.error;
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (!is_fixed_[i]) continue;
      diagonal[i] = 1.0;
      right[i].setZero();
      above[i] = 0.0;
      if (i > 0) above[i - 1] = 0.0;
    }
    for (std::size_t i = 1; i < n; ++i) {
      const double factor = above[i - 1] / diagonal[i - 1];
      diagonal[i] -= factor * above[i - 1];
      right[i] -= factor * right[i - 1];
    }
    for (std::size_t i = n; i-- > 0;)
      at_[i] = (right[i] - (i + 1 < n ? Vec3(above[i] * at_[i + 1]) : Vec3::Zero())) / diagonal[i];
  }
  Vec3 of(const Sample& s) const {
    const auto i = static_cast<std::size_t>(s.piece);
    return s.along == 0.0 ? at_[i] : Vec3((1 - s.along) * at_[i] + s.along * at_[i + 1]);
  }
  const Vec3& operator[](std::size_t i) const { return at_[i]; }

 private:
  std::vector<bool> is_fixed_;
  std::vector<Vec3> at_;
};

bool contains(std::span<const int> frames, int frame) {
  return std::binary_search(frames.begin(), frames.end(), frame);
}

std::vector<Sample> samples_between(const KeyCurve& curve, int first, int last) {
  std::vector<Sample> samples;
  for (int k = first; k <= last; ++k) {
    const int from = curve.keys[k];
    const int to = k < last ? curve.keys[k + 1] : from + 1;
    for (int f = from; f < to; ++f)
      samples.push_back({k - first, static_cast<double>(f - from) / (to - from),
                         difference(curve.path, curve.reduced[f], curve.wanted[f])});
  }
  return samples;
}

}  // namespace

double distance(TrackPath path, const KeyValue& a, const KeyValue& b) {
  // The chord of two unit quaternions is half the angle to third order.
  return (path == TrackPath::rotation ? 2.0 : 1.0) * (a - b).norm();
}

bool is_short_way(TrackPath path, const KeyValue& a, const KeyValue& b) {
  return path != TrackPath::rotation || a.dot(b) > 0.05;
}

void interpolate(KeyCurve& curve, int first, int last) {
  for (int k = first; k <= last; ++k) {
    const int from = curve.keys[k];
    curve.reduced[from] = curve.values[k];
    if (k == last) break;
    each_between(curve.path, curve.values[k], curve.values[k + 1], curve.keys[k + 1] - from,
                 [&](int step, const KeyValue& v) {
                   curve.reduced[from + step] = v;
                   return true;
                 });
  }
}

void choose_keys(KeyCurve& curve, double tolerance, std::span<const int> pinned) {
  curve.keys = {0};
  curve.values = {curve.wanted.front()};
  while (curve.keys.back() < curve.last_frame()) {
    const int from = curve.keys.back();
    const int end = *std::upper_bound(pinned.begin(), pinned.end(), from);
    const auto fits = [&](int to) {
      const auto is_near = [&](int k, const KeyValue& v) {
        return distance(curve.path, v, curve.wanted[from + k]) <= kSlack * tolerance;
      };
      return is_short_way(curve.path, curve.wanted[from], curve.wanted[to]) &&
             each_between(curve.path, curve.wanted[from], curve.wanted[to], to - from, is_near);
    };
    curve.keys.push_back(longest_piece(from, end, fits));
    curve.values.push_back(curve.wanted[curve.keys.back()]);
  }
  interpolate(curve, 0, static_cast<int>(curve.keys.size()) - 1);
}

void fit_values(KeyCurve& curve, double tolerance, int first, int last, std::span<const int> pinned) {
  const int before = std::max(first - 1, 0);
  const int after = std::min(last + 1, static_cast<int>(curve.keys.size()) - 1);
  std::vector<bool> is_fixed;
  for (int k = before; k <= after; ++k)
    is_fixed.push_back(k < first || k > last || contains(pinned, curve.keys[k]));
  std::vector<Sample> samples = samples_between(curve, before, after);
  Corrections corrections(std::move(is_fixed));
  for (int round = 0; round < kFitRounds; ++round) {
    corrections.solve(samples);
    for (Sample& s : samples) s.weight *= kLeastGrowth + (s.error - corrections.of(s)).norm() / tolerance;
  }
  for (int k = before; k <= after; ++k)
    curve.values[k] = moved(curve.path, curve.values[k], corrections[static_cast<std::size_t>(k - before)]);
  interpolate(curve, before, after);
}

}  // namespace ukemi
