#include "prepare/start.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/nearest.h"
#include "clip/ground_motion.h"
#include "clip/names.h"
#include "clip/start.h"
#include "prepare/in_place.h"
#include "prepare/motion.h"
#include "prepare/settings.h"

namespace ukemi {
namespace {

constexpr double kVelocityStep = 1.0 / 240.0;  // s, to either side
constexpr double kFastest = 20.0;              // m/s, of a body 1.75 m tall: faster than ordinary motion
constexpr double kFastestTurn = 60.0;          // rad/s
constexpr double kFloorRate = 30.0;            // samples per second of a clip
constexpr int kMaxFloorSamples = 600;
constexpr double kStride_s = 0.5;        // to either side of the start: both feet stand in it
constexpr double kSameFloor = 0.025;     // of the height
const double kRoundTurn = radians(1.5);  // between the first and the last pose of a cycle
constexpr double kRoundShift = 0.005;    // of the body height
constexpr double kShortestRound = 0.2;   // s
constexpr double kStillSpeed = 0.02;     // m/s

Result<Pose> still_pose(const Character& character, const Humanoid& humanoid, const std::string& text,
                        const StanceOptions& stance, Diagnostics& diagnostics) {
  const std::pair<std::string_view, StartPose> poses[] = {
      {"rest", StartPose::rest}, {"stand", StartPose::stand}, {"guard", StartPose::guard}};
  for (const auto& [word, pose] : poses)
    if (word == text) return start_pose(character, humanoid, pose, stance);
  if (names_motion_file(text)) return pose_of_file(character, humanoid, text, diagnostics);
  return usage_error(fmt::format("unknown pose '{}'", text),
                     suggestion(text, {"rest", "stand", "guard"}) + ", or name a .bvh, .glb or .fbx file");
}

/// A body that is to keep its feet planted leans into the blow.
Vec2 braced_against(const BakeSettings& settings) {
  if (settings.most_steps > 0.0) return Vec2::Zero();
  return {std::cos(settings.from.azimuth), -std::sin(settings.from.azimuth)};
}

/// Differences of the segments as the nodes have them (their rolls do not jump) between two times of a clip;
/// false where they are faster than any body: a cut, or a calibration pose before the motion.
bool take_velocities(const Skeleton& skeleton, const Humanoid& humanoid, const Animation& animation,
                     double before, double after, StartState& state) {
  before = std::max(animation.start_s, before);
  after = std::min(animation.end_s, after);
  if (!(after > before)) return false;
  const BodyPose a = segments_of(skeleton, humanoid, sample(skeleton, animation, before));
  const BodyPose b = segments_of(skeleton, humanoid, sample(skeleton, animation, after));
  const double fastest = kFastest * std::max(1.0, humanoid.height_m / 1.75);
  PerSegment<Vec3> linear, angular;
  for (int i = 0; i < kSegmentCount; ++i) {
    linear[i] = (b[i].translation - a[i].translation) / (after - before);
    angular[i] = log_rotation(b[i].rotation * a[i].rotation.conjugate()) / (after - before);
    if (linear[i].norm() > fastest || angular[i].norm() > kFastestTurn) return false;
  }
  state.linear_velocity = linear;
  state.angular_velocity = angular;
  return true;
}

/// Central differences; where the clip jumps, those of the side that does not; else zero, with a warning.
void find_velocities(const Skeleton& skeleton, const Humanoid& humanoid, const Animation& animation,
                     double time_s, StartState& state, Diagnostics& diagnostics) {
  if (!(animation.duration_s() > 0.0)) return;
  const double before = time_s - kVelocityStep, after = time_s + kVelocityStep;
  if (take_velocities(skeleton, humanoid, animation, before, after, state)) return;
  if (take_velocities(skeleton, humanoid, animation, time_s, after, state)) return;
  if (take_velocities(skeleton, humanoid, animation, before, time_s, state)) return;
  diagnostics.warn(
      animation.name,
      fmt::format("the clip jumps at {:.3f} s: the body starts from that pose at rest; --at chooses "
                  "another time",
                  time_s - animation.start_s));
}

/// Poses of the clip from one time to another, s after its start.
std::vector<Pose> floor_samples(const Skeleton& skeleton, const Animation& animation, double from_s,
                                double to_s) {
  const double wanted = (to_s - from_s) * kFloorRate;
  const int last = static_cast<int>(std::min(wanted, static_cast<double>(kMaxFloorSamples)));
  std::vector<Pose> poses;
  for (int i = 0; i <= last; ++i) {
    const double share = last > 0 ? static_cast<double>(i) / last : 0.0;
    poses.push_back(sample(skeleton, animation, animation.start_s + from_s + share * (to_s - from_s)));
  }
  return poses;
}

/// Height of the floor that the start stands on. Captured floors slope and drift: that of the strides about
/// the start, unless it is another floor than the clip's (a leap, a step).
double floor_at(const Character& character, const Humanoid& humanoid, const Animation& motion, double at_s) {
  const auto floor_between = [&](double from_s, double to_s) {
    return floor_of(character, humanoid, floor_samples(character.skeleton, motion, from_s, to_s));
  };
  const double whole = floor_between(0.0, motion.duration_s());
  const double near =
      floor_between(std::max(0.0, at_s - kStride_s), std::min(motion.duration_s(), at_s + kStride_s));
  return std::abs(near - whole) < kSameFloor * humanoid.height_m ? near : whole;
}

/// What a body starts from: its clip, or nothing for a still pose.
Result<std::optional<Animation>> motion_of(const Character& character, const Humanoid& humanoid,
                                           const BakeSettings& settings, Diagnostics& diagnostics) {
  if (settings.pose && settings.clip)
    return usage_error("--pose and --clip exclude each other", "give one of them");
  std::size_t own = 0;
  if (settings.clip) {
    const auto clip = find_clip(character, *settings.clip);
    if (!clip && names_motion_file(*settings.clip)) {
      auto motion = motion_of_file(character, humanoid, *settings.clip, diagnostics);
      if (!motion) return motion.error();
      return std::optional(std::move(*motion));
    }
    if (!clip) return clip.error();
    own = *clip;
  } else if (settings.pose || !is_motion_only(character)) {
    if (settings.at_s)
      return usage_error("--at needs a clip to take the time from", "add --clip NAME, or leave out --at");
    return std::optional<Animation>();
  }
  std::optional<Animation> motion = character.animations[own];
  motion->name = clip_label(character, own);
  return motion;
}

/// Whether some segment is under way between two times, up to a hundredth of a second apart.
bool moves(const Skeleton& skeleton, const Humanoid& humanoid, const Animation& motion, double from_s,
           double to_s) {
  const BodyPose a = segments_of(skeleton, humanoid, sample(skeleton, motion, from_s));
  const BodyPose b = segments_of(skeleton, humanoid, sample(skeleton, motion, to_s));
  for (int s = 0; s < kSegmentCount; ++s)
    if ((b[s].translation - a[s].translation).norm() > kStillSpeed * (to_s - from_s)) return true;
  return false;
}

/// See Start::round. A motion that comes to rest where it began (a blow out of a guard) is not a round.
std::optional<Rigid> round_of(const Skeleton& skeleton, const Humanoid& humanoid, const Animation& motion) {
  if (motion.duration_s() < kShortestRound) return std::nullopt;
  const double step_s = 2.0 * kVelocityStep;
  if (!moves(skeleton, humanoid, motion, motion.start_s, motion.start_s + step_s) ||
      !moves(skeleton, humanoid, motion, motion.end_s - step_s, motion.end_s))
    return std::nullopt;
  const BodyPose first = segments_of(skeleton, humanoid, sample(skeleton, motion, motion.start_s));
  const BodyPose last = segments_of(skeleton, humanoid, sample(skeleton, motion, motion.end_s));
  constexpr int pelvis = index(Segment::pelvis);
  const GroundMove move = ground_move({first[pelvis]}, {last[pelvis]});
  for (int s = 0; s < kSegmentCount; ++s) {
    const Rigid expected = move * first[s];
    if (angle_between(expected.rotation, last[s].rotation) > kRoundTurn ||
        (expected.translation - last[s].translation).norm() > kRoundShift * humanoid.height_m)
      return std::nullopt;
  }
  return move * Rigid{};
}

/// A clip that walks on the spot is made to go over the ground, as the figure does in the game.
void make_it_go(const Character& character, const Humanoid& humanoid, const BakeSettings& settings,
                Animation& motion, Diagnostics& diagnostics) {
  if (settings.ground_speed_m_s == 0.0) return;
  const auto velocity = gait_in_place(character, humanoid, motion);
  if (!velocity) {
    if (settings.ground_speed_m_s)
      diagnostics.warn(motion.name,
                       "--ground-speed has no effect: the clip does not walk or run on the spot");
    return;
  }
  const double speed = settings.ground_speed_m_s.value_or(velocity->norm());
  if (!settings.ground_speed_m_s)
    diagnostics.warn(
        motion.name,
        fmt::format("walks or runs on the spot: taken to go at {:.2f} m/s, as its feet slide back; "
                    "--ground-speed sets it, 0 leaves it on the spot",
                    speed));
  motion = going_on(character.skeleton, humanoid, motion, speed * velocity->normalized());
}

Result<Start> start_from_motion(const Character& character, const Humanoid& humanoid,
                                const BakeSettings& settings, Animation motion, Diagnostics& diagnostics) {
  const double at_s = settings.at_s.value_or(0.0);
  if (!(at_s >= 0.0) || at_s > motion.duration_s() + 1e-6)
    return usage_error(fmt::format("--at {} lies outside the clip '{}'", at_s, motion.name),
                       fmt::format("give a time from 0 to {:.3f} s", motion.duration_s()));
  make_it_go(character, humanoid, settings, motion, diagnostics);
  Start start;
  start.name = motion.name;
  start.from_clip = true;
  start.at_s = at_s;
  start.pose = sample(character.skeleton, motion, motion.start_s + at_s);
  const double floor_m = floor_at(character, humanoid, motion, at_s);
  start.floor_m = std::min(floor_m, height_above_floor(character, humanoid, start.pose));
  find_velocities(character.skeleton, humanoid, motion, motion.start_s + at_s, start.state, diagnostics);
  start.round = round_of(character.skeleton, humanoid, motion);
  start.motion = std::move(motion);
  return start;
}

}  // namespace

Result<Start> start_of(const Character& character, const Humanoid& humanoid, const BakeSettings& settings,
                       Diagnostics& diagnostics) {
  auto motion = motion_of(character, humanoid, settings, diagnostics);
  if (!motion) return motion.error();
  Start start;
  if (*motion) {
    auto from_motion = start_from_motion(character, humanoid, settings, std::move(**motion), diagnostics);
    if (!from_motion) return from_motion.error();
    start = std::move(*from_motion);
  } else {
    start.name = settings.pose.value_or("stand");
    const StanceOptions stance{behaviour_settings(settings).kind != Behaviour::limp, braced_against(settings),
                               static_cast<std::uint64_t>(settings.seed)};
    auto pose = still_pose(character, humanoid, start.name, stance, diagnostics);
    if (!pose) return pose.error();
    start.pose = std::move(*pose);
  }
  start.segments = canonical_segments_of(character.skeleton, humanoid, start.pose);
  start.state.segments = start.segments;
  for (Rigid& segment : start.state.segments) segment.translation.y() -= start.floor_m;
  return start;
}

}  // namespace ukemi
