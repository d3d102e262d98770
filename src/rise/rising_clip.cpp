#include "rise/rising_clip.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "body/on_ground.h"
#include "rise/get_up.h"

namespace ukemi {
namespace {

constexpr double kStill_m_s = 0.08;    // root mean square of the segments, of a man of 1.75 m
constexpr double kUpright_s = 1.0;     // that a motion may go on after the figure is upright, before it ends
constexpr double kStill_s = 0.15;      // of a figure that has come to rest
constexpr double kOnFloor = 0.30;      // of the height: pelvis of a body that lies, sits or kneels
constexpr double kStands = 0.85;       // of the highest pelvis of the motion
constexpr double kTrunkUp = 0.7;       // upward part of the trunk's axis, of a figure that stands
constexpr double kRises = 0.22;        // of the height: pelvis of one that has begun to rise
constexpr double kLookAt_hz = 20.0;    // moments of a clip
constexpr double kVelocity_s = 0.10;   // metres that a metre a second counts
constexpr double kTurn_m = 0.12;       // metres that a radian counts
constexpr double kSkipped_m_s = 0.05;  // metres that a second of the clip that is left out counts

// Means of moves whose peak is 1.875 times as fast: joints of captured get-ups are slower than 360 degrees a
// second in 99 of 100 frames.
constexpr double kJointSpeed = radians(190.0), kRollSpeed = radians(90.0);
constexpr double kLimbSpeed = 1.0, kScootSpeed = 0.4, kHeadSpeed = 0.6;  // m/s, of a man of 1.75 m
constexpr double kLiftSpeed = 0.15;  // m/s, of the pelvis: to lift it is a motion of its own

double man_scale(const ArticulatedBody& body) { return std::sqrt(body.height_m / 1.75); }

double speed_between(const BodyPose& a, const BodyPose& b, double span_s) {
  double sum = 0.0;
  for (int s = 0; s < kSegmentCount; ++s) sum += (b[s].translation - a[s].translation).squaredNorm();
  return std::sqrt(sum / kSegmentCount) / span_s;
}

/// Speeds of the figure in every frame, over 50 ms to either side.
std::vector<double> speeds_of(const std::vector<BodyPose>& motion, double fps) {
  const int last = static_cast<int>(motion.size()) - 1;
  const int span = std::max(1, static_cast<int>(std::lround(0.05 * fps)));
  std::vector<double> speeds;
  for (int f = 0; f <= last; ++f) {
    const int a = std::max(0, f - span), b = std::min(last, f + span);
    speeds.push_back(b > a ? speed_between(motion[a], motion[b], (b - a) / fps) : 0.0);
  }
  return speeds;
}

/// The turn about y and the shift over the ground that take `from` nearest to `to`, by the segments' masses
/// (Kabsch 1976, in the plane).
Rigid best_fit(const ArticulatedBody& body, const BodyPose& from, const BodyPose& to) {
  Vec2 mean_from = Vec2::Zero(), mean_to = Vec2::Zero();
  const auto centre = [&](const BodyPose& pose, int s) {
    return on_ground(pose[s] * body.segments[s].centre_of_mass);
  };
  for (int s = 0; s < kSegmentCount; ++s) {
    mean_from += body.segments[s].mass_kg / body.mass_kg * centre(from, s);
    mean_to += body.segments[s].mass_kg / body.mass_kg * centre(to, s);
  }
  double along = 0.0, across = 0.0;
  for (int s = 0; s < kSegmentCount; ++s) {
    const Vec2 p = centre(from, s) - mean_from, q = centre(to, s) - mean_to;
    along += body.segments[s].mass_kg * p.dot(q);
    across += body.segments[s].mass_kg * (p.y() * q.x() - p.x() * q.y());
  }
  Rigid move;
  move.rotation = exp_rotation(std::atan2(across, along) * Vec3::UnitY());
  move.translation = at_height(mean_to, 0.0) - move.rotation * at_height(mean_from, 0.0);
  return move;
}

/// How far the trunk rolls.
double trunk_turn(const BodyPose& a, const BodyPose& b) {
  const auto turn = [&](Segment s) { return angle_between(a[index(s)].rotation, b[index(s)].rotation); };
  return std::max(turn(Segment::pelvis), turn(Segment::chest));
}

double joint_turn(const BodyPose& a, const BodyPose& b, int joint) {
  const int child = joint + 1, parent = index(parent_of(segment_at(child)));
  return angle_between(a[parent].rotation.conjugate() * a[child].rotation,
                       b[parent].rotation.conjugate() * b[child].rotation);
}

/// Seconds from one pose to the other, see kJointSpeed.
double time_between(const ArticulatedBody& body, const BodyPose& a, const BodyPose& b) {
  double seconds = trunk_turn(a, b) / kRollSpeed;
  for (int j = 0; j < kJointCount; ++j)
    if (!body.joints[j].fused) seconds = std::max(seconds, joint_turn(a, b, j) / kJointSpeed);
  const auto way = [&](Segment s) { return (b[index(s)].translation - a[index(s)].translation).norm(); };
  seconds = std::max(seconds, way(Segment::pelvis) / (kScootSpeed * man_scale(body)));
  seconds =
      std::max({seconds, way(Segment::head) / (kHeadSpeed * man_scale(body)),
                std::abs(b[0].translation.y() - a[0].translation.y()) / (kLiftSpeed * man_scale(body))});
  for (const Segment s : {Segment::hand_l, Segment::hand_r, Segment::foot_l, Segment::foot_r})
    seconds = std::max(seconds, way(s) / (kLimbSpeed * man_scale(body)));
  return seconds;
}

/// How one moment of a clip compares with the lying body.
struct ComparedMoment {
  ClipEntry entry;
  double cost_m = 0.0;
};

class MomentComparison {
 public:
  MomentComparison(const ArticulatedBody& body, const BodyPose& before, const BodyPose& lying, double fps)
      : body_(body), lying_(lying) {
    for (int s = 0; s < kSegmentCount; ++s)
      velocity_[s] = fps * (lying[s].translation - before[s].translation);
  }

  ComparedMoment at(const RisingClip& clip, int frame) const {
    ComparedMoment result;
    ClipEntry& entry = result.entry;
    entry.frame = frame;
    entry.world_from_clip = best_fit(body_, clip.frames[frame], lying_);
    BodyPose moved = clip.frames[frame];
    const int next = std::min(frame + 1, static_cast<int>(clip.frames.size()) - 1);
    double apart = 0.0, turned = 0.0, speed = 0.0;
    for (int s = 0; s < kSegmentCount; ++s) {
      const Vec3 way = clip.fps * (clip.frames[next][s].translation - clip.frames[frame][s].translation);
      moved[s] = entry.world_from_clip * moved[s];
      apart += (moved[s].translation - lying_[s].translation).squaredNorm();
      turned += std::pow(angle_between(moved[s].rotation, lying_[s].rotation), 2.0);
      speed += (entry.world_from_clip.rotation * way - velocity_[s]).squaredNorm();
    }
    entry.apart_m = std::sqrt(apart / kSegmentCount);
    entry.turned_deg = degrees(std::sqrt(turned / kSegmentCount));
    entry.needed_s = time_between(body_, lying_, moved);
    result.cost_m = entry.apart_m + kTurn_m * radians(entry.turned_deg) +
                    kVelocity_s * std::sqrt(speed / kSegmentCount) + kSkipped_m_s * frame / clip.fps;
    return result;
  }

 private:
  const ArticulatedBody& body_;
  const BodyPose& lying_;
  std::array<Vec3, kSegmentCount> velocity_;
};

/// First and last frame.
struct Stretch {
  int first, last;
};

double trunk_up(const BodyPose& pose) { return (pose[index(Segment::chest)].rotation * Vec3::UnitY()).y(); }

/// One stretch for each time that somebody gets up: from the first frame on the floor to the last before the
/// figure stands.
std::vector<Stretch> stretches_on_floor(const ArticulatedBody& body, const std::vector<BodyPose>& motion) {
  double highest = 0.0;
  for (const BodyPose& pose : motion) highest = std::max(highest, pose[0].translation.y());
  std::vector<Stretch> stretches;
  Stretch now{-1, -1};
  bool low = false;
  for (int f = 0; f < static_cast<int>(motion.size()); ++f) {
    const double pelvis_m = motion[f][0].translation.y();
    if (lying_of(body, motion[f]) != Lying::upright) {
      if (now.first < 0) now.first = f, low = false;
      now.last = f;
      low = low || pelvis_m < kOnFloor * body.height_m;
    } else if (now.first >= 0 && pelvis_m > kStands * highest && trunk_up(motion[f]) > kTrunkUp) {
      if (low) stretches.push_back(now);
      now.first = -1;
    }
  }
  return stretches;
}

bool lies_flat(const ArticulatedBody& body, const BodyPose& pose) {
  const Lying how = lying_of(body, pose);
  return how != Lying::upright && how != Lying::seated && how != Lying::kneeling;
}

/// Where a get-up begins: after a fall at the end of the last stillness in which the figure lies, or of the
/// first in which it sits or kneels; in a motion that begins on the floor at the end of its first stillness.
int beginning(const ArticulatedBody& body, const std::vector<BodyPose>& motion, const Stretch& stretch,
              const std::vector<double>& speeds, double still) {
  int f = stretch.first;
  if (f > 0) {
    for (int k = stretch.last; k > stretch.first; --k)
      if (speeds[k] <= still && lies_flat(body, motion[k])) return k;
    while (f < stretch.last && speeds[f] > still) ++f;
  }
  while (f < stretch.last && speeds[f] <= still) ++f;
  return f < stretch.last ? f : stretch.first;
}

/// Where it ends; `limit`: the last frame before the next fall.
int ending(const Stretch& stretch, int limit, const std::vector<double>& speeds, double fps, double still) {
  const int from = stretch.last + static_cast<int>(std::lround(kUpright_s * fps));
  const int rest = std::max(1, static_cast<int>(std::lround(kStill_s * fps)));
  int quiet = 0;
  for (int f = stretch.last; f <= limit; ++f) {
    quiet = speeds[f] <= 1.5 * still ? quiet + 1 : 0;
    if (f >= from && quiet >= rest) return f;
  }
  return limit;
}

}  // namespace

std::vector<RisingClip> rising_clips_of(const ArticulatedBody& body, const std::string& name, double fps,
                                        const std::vector<BodyPose>& motion) {
  const double still = kStill_m_s * man_scale(body);
  const std::vector<double> speeds = speeds_of(motion, fps);
  const std::vector<Stretch> stretches = stretches_on_floor(body, motion);
  std::vector<RisingClip> clips;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const int limit =
        i + 1 < stretches.size() ? stretches[i + 1].first - 1 : static_cast<int>(motion.size()) - 1;
    RisingClip clip;
    clip.name = name;
    clip.fps = fps;
    const int first = beginning(body, motion, stretches[i], speeds, still);
    clip.from_s = first / fps;
    clip.frames.assign(motion.begin() + first,
                       motion.begin() + ending(stretches[i], limit, speeds, fps, still) + 1);
    clip.floor_frames = 1;
    while (first + clip.floor_frames < stretches[i].last &&
           motion[first + clip.floor_frames][0].translation.y() < kRises * body.height_m)
      ++clip.floor_frames;
    clips.push_back(std::move(clip));
  }
  return clips;
}

std::optional<ClipEntry> nearest_entry(const ArticulatedBody& body, const std::vector<RisingClip>& library,
                                       const BodyPose& before, const BodyPose& lying, double fps) {
  const MomentComparison comparison(body, before, lying, fps);
  std::optional<ComparedMoment> best;
  for (std::size_t c = 0; c < library.size(); ++c) {
    const int stride = std::max(1, static_cast<int>(std::lround(library[c].fps / kLookAt_hz)));
    for (int f = 0; f < library[c].floor_frames; f += stride) {
      ComparedMoment here = comparison.at(library[c], f);
      here.entry.clip = c;
      const bool nearer =
          !best || (here.entry.in_reach() == best->entry.in_reach() ? here.cost_m < best->cost_m
                                                                    : here.entry.in_reach());
      if (nearer) best = here;
    }
  }
  return best ? std::optional(best->entry) : std::nullopt;
}

}  // namespace ukemi
