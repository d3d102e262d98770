#include "judge/judged_motion.h"

#include <cmath>
#include <optional>

namespace ukemi {
namespace {

constexpr double kMan_kg = 73.0, kMan_m = 1.741;  // de Leva 1996
// Shares of stature: crown above the skull base, knuckle below the wrist, ball of the foot from the ankle.
constexpr double kCrown = 0.12, kKnuckle = 0.055, kBallForward = 0.08, kBallDown = 0.03;

/// What a file says about where segments end.
class Ends {
 public:
  Ends(const Character& character, const Humanoid& humanoid, const Pose& pose, const BodyPose& segments)
      : character_(character),
        humanoid_(humanoid),
        segments_(segments),
        world_(world_transforms(character.skeleton, pose)) {}

  Vec3 of(Segment segment, int landmark, const Vec3& otherwise) const {
    const auto place =
        landmark >= 0 ? std::optional<Vec3>(world_[landmark].translation()) : end_site(segment);
    if (!place) return otherwise;
    return segments_[index(segment)].inverse() * (humanoid_.world_from_file * *place);
  }

 private:
  /// The end site in the file, of a segment whose node has one.
  std::optional<Vec3> end_site(Segment segment) const {
    const int node = humanoid_.segments[index(segment)].node();
    if (node < 0 || !character_.bvh || !character_.bvh->end_site[node]) return std::nullopt;
    return world_[node] * *character_.bvh->end_site[node];
  }

  const Character& character_;
  const Humanoid& humanoid_;
  const BodyPose& segments_;
  std::vector<Affine> world_;
};

}  // namespace

BodyEnds body_ends(const Character& character, const Humanoid& humanoid, const Pose& pose,
                   const BodyPose& segments) {
  const Ends file(character, humanoid, pose, segments);
  const double h = humanoid.height_m;
  BodyEnds ends;
  ends.crown = file.of(Segment::head, humanoid.head_top, Vec3(0.0, kCrown * h, 0.0));
  for (int side = 0; side < 2; ++side) {
    const Segment hand = side == 0 ? Segment::hand_l : Segment::hand_r;
    const Segment foot = side == 0 ? Segment::foot_l : Segment::foot_r;
    ends.knuckle[side] = Vec3::Zero();
    if (!humanoid.segments[index(hand)].fused())
      ends.knuckle[side] = file.of(hand, humanoid.middle_finger[side], Vec3(0.0, -kKnuckle * h, 0.0));
    ends.ball_of_foot[side] = file.of(foot, humanoid.toes[side], Vec3(kBallForward * h, -kBallDown * h, 0.0));
  }
  return ends;
}

JudgedMotion judged_motion(const Character& character, const Humanoid& humanoid, const Clip& clip) {
  JudgedMotion motion;
  motion.fps = clip.fps;
  motion.height_m = humanoid.height_m;
  motion.mass_kg = kMan_kg * std::pow(humanoid.height_m / kMan_m, 3.0);
  motion.frames.reserve(clip.frames.size());
  for (const Pose& pose : clip.frames)
    motion.frames.push_back(segments_of(character.skeleton, humanoid, pose));
  for (int i = 0; i < kSegmentCount; ++i) motion.fused[i] = humanoid.segments[i].fused();
  motion.ends = body_ends(character, humanoid, clip.frames.front(), motion.frames.front());
  return motion;
}

}  // namespace ukemi
