#include "rise/bearing_points.h"

#include <algorithm>
#include <cmath>

#include "body/on_ground.h"

namespace ukemi {
namespace {

constexpr Segment kLimbs[] = {Segment::hand_l,  Segment::forearm_l, Segment::hand_r,  Segment::forearm_r,
                              Segment::shank_l, Segment::foot_l,    Segment::shank_r, Segment::foot_r};
constexpr double kLow = 0.018;        // of the height
constexpr double kSlow_m_s = 0.22;    // of a man of 1.75 m
constexpr double kShortest_s = 0.12;  // of a rest
constexpr double kGap_s = 0.10;       // that does not end one
constexpr double kFar = 0.045;        // of the height: a point that has gone so far bears elsewhere
constexpr double kApart = 0.04;       // of the height: of two points of a segment
constexpr int kPoints = 2;            // of a segment

class RestSearch {
 public:
  RestSearch(const WholeBody& whole, const std::vector<BodyPose>& motion, double fps)
      : motion_(motion), fps_(fps), height_m_(whole.body().height_m) {}

  /// Rests of one point.
  std::vector<Bearing> rests_of(Segment segment, const Vec3& point) const {
    std::vector<Bearing> rests;
    Vec2 sum = Vec2::Zero();
    int count = 0;
    const auto close = [&] {
      if (rests.empty() || count == 0) return;
      if (rests.back().last - rests.back().first < kShortest_s * fps_) rests.pop_back();
      count = 0;
    };
    for (int f = 0; f < static_cast<int>(motion_.size()); ++f) {
      const Vec3 at = motion_[f][index(segment)] * point;
      if (at.y() > kLow * height_m_ || speed(segment, point, f) > slow()) continue;
      const bool goes_on = count > 0 && f - rests.back().last <= kGap_s * fps_ &&
                           (on_ground(at) - sum / count).norm() < kFar * height_m_;
      if (!goes_on) {
        // A part that slides on is not pinned to one place after the other.
        const bool slides = count > 0 && f - rests.back().last <= kGap_s * fps_;
        if (slides) continue;
        close();
        rests.push_back({f, f, Vec3::Zero()});
        sum.setZero();
      }
      rests.back().last = f;
      sum += on_ground(at);
      ++count;
    }
    close();
    return rests;
  }

 private:
  double slow() const { return kSlow_m_s * std::sqrt(height_m_ / 1.75); }
  double speed(Segment segment, const Vec3& point, int frame) const {
    const int span = std::max(1, static_cast<int>(std::lround(0.04 * fps_)));
    const int a = std::max(0, frame - span), b = std::min(static_cast<int>(motion_.size()) - 1, frame + span);
    if (b <= a) return 0.0;
    return (motion_[b][index(segment)] * point - motion_[a][index(segment)] * point).norm() * fps_ / (b - a);
  }

  const std::vector<BodyPose>& motion_;
  double fps_, height_m_;
};

int frames_in(const std::vector<Bearing>& rests) {
  int frames = 0;
  for (const Bearing& rest : rests) frames += rest.last - rest.first + 1;
  return frames;
}

/// Places of the rests of a segment, in the order of time. A part that bears already stays where it is. A
/// rest that begins while the segment rests on another point follows from where that is held; other rests
/// lie where the motion has the point in the middle of the rest.
void place_rests(const std::vector<BodyPose>& motion, std::vector<BearingPoint>& points) {
  struct Rest {
    const Vec3* point;
    Bearing* rest;
  };
  std::vector<Rest> rests;
  for (BearingPoint& point : points)
    for (Bearing& rest : point.rests) rests.push_back({&point.point, &rest});
  std::stable_sort(rests.begin(), rests.end(),
                   [](const Rest& a, const Rest& b) { return a.rest->first < b.rest->first; });
  const auto place = [&](int frame, const Vec3& point) {
    return on_ground(motion[static_cast<std::size_t>(frame)][index(points.front().segment)] * point);
  };
  for (std::size_t i = 0; i < rests.size(); ++i) {
    Bearing& rest = *rests[i].rest;
    Vec2 at = place(rest.first == 0 ? 0 : (rest.first + rest.last) / 2, *rests[i].point);
    for (std::size_t k = 0; k < i; ++k)
      if (const Bearing& other = *rests[k].rest; other.last >= rest.first && rest.first > 0)
        at = place(rest.first, *rests[i].point) + on_ground(other.place) - place(rest.first, *rests[k].point);
    rest.place = at_height(at, 0.0);
  }
}

/// The half of a forearm at the wrist moves with the hand.
bool is_of_next(const WholeBody& whole, Segment segment, const Vec3& point) {
  if (segment != Segment::forearm_l && segment != Segment::forearm_r) return false;
  const Joint wrist = segment == Segment::forearm_l ? Joint::wrist_l : Joint::wrist_r;
  return point.norm() > 0.5 * whole.body().joints[index(wrist)].anchor_in_parent.norm();
}

}  // namespace

std::vector<BearingPoint> bearing_points(const WholeBody& whole, const std::vector<BodyPose>& motion,
                                         double fps) {
  const RestSearch search(whole, motion, fps);
  std::vector<BearingPoint> result;
  for (const Segment segment : kLimbs) {
    std::vector<BearingPoint> candidates;
    for (const Vec3& point : whole.skin()[index(segment)])
      if (auto rests = search.rests_of(segment, point); !rests.empty() && !is_of_next(whole, segment, point))
        candidates.push_back({segment, point, std::move(rests)});
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return frames_in(a.rests) > frames_in(b.rests); });
    std::vector<BearingPoint> taken;
    for (BearingPoint& candidate : candidates) {
      const bool apart = std::all_of(taken.begin(), taken.end(), [&](const BearingPoint& other) {
        return (other.point - candidate.point).norm() > kApart * whole.body().height_m;
      });
      if (apart) taken.push_back(std::move(candidate));
      if (taken.size() == kPoints) break;
    }
    if (!taken.empty()) place_rests(motion, taken);
    for (BearingPoint& point : taken) result.push_back(std::move(point));
  }
  return result;
}

}  // namespace ukemi
