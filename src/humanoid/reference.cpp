#include "humanoid/reference.h"

#include <algorithm>
#include <cmath>

#include "humanoid/landmarks.h"

namespace ukemi {

std::vector<double> sample_times(const Animation& animation, int at_most) {
  const double fps = animation.fps > 0.0 ? animation.fps : 30.0;
  const int frames = std::max(1, static_cast<int>(std::lround(animation.duration_s() * fps)) + 1);
  const int stride = (frames + at_most - 1) / at_most;
  std::vector<double> times;
  for (int i = 0; i < frames; i += stride) times.push_back(animation.start_s + i / fps);
  return times;
}

namespace {

// ------------------------------------------------------------------------------------------

/// How far the lowest joint of a motion moves along `up`, file units: little along the true one, for the
/// floor carries the figure, whether it stands or lies.
double spread_of_lowest(const std::vector<Landmarks>& figures, const Vec3& up) {
  double least = 1e300, most = -1e300;
  for (const Landmarks& figure : figures) {
    double lowest = 1e300;
    for (const Vec3& origin : figure.origin) lowest = std::min(lowest, origin.dot(up));
    least = std::min(least, lowest);
    most = std::max(most, lowest);
  }
  return most - least;
}

/// The up axis of a motion: where the head is above the feet, in the mean or, for a figure that spends most
/// of the time on the ground, at the beginning.
Vec3 up_of_motion(const Character& character, const Humanoid& humanoid) {
  std::vector<Landmarks> figures;
  for (const double t : sample_times(character.animations[0], 100))
    figures.emplace_back(character, humanoid, sample(character.skeleton, character.animations[0], t));
  const auto mean_rise = [&](std::size_t count) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < count; ++i) sum += figures[i].rise().normalized();
    return dominant_axis(sum);
  };
  const Vec3 mean = mean_rise(figures.size());
  const Vec3 first = mean_rise((figures.size() + 9) / 10);
  return spread_of_lowest(figures, first) < spread_of_lowest(figures, mean) ? first : mean;
}

Pose turned(const Character& character, Pose pose, const Quat& rotation) {
  for (int i = 0; i < character.skeleton.size(); ++i)
    if (character.skeleton.nodes[i].parent < 0) {
      pose[i].rotation = rotation * pose[i].rotation;
      pose[i].translation = rotation * pose[i].translation;
    }
  return pose;
}

/// First exact T-pose of the motion, else the frame nearest to the neutral pose.
Reference best_frame(const Character& character, const Humanoid& humanoid, const Vec3& up) {
  Pose best = rest_pose(character.skeleton);
  double best_tilt = 1e300;
  for (const double t : sample_times(character.animations[0], 4000)) {
    Pose pose = sample(character.skeleton, character.animations[0], t);
    const Landmarks figure(character, humanoid, pose);
    if (exact_t_pose(figure, up)) return {pose, up, false};
    if (const double tilt = neutrality(figure, up); tilt < best_tilt) {
      best_tilt = tilt;
      best = std::move(pose);
    }
  }
  return {best, up, true};
}

/// The pose in which the skin was bound, where inverse-bind matrices give it: joints whose parent is in the
/// same skin, all others as at rest.
Pose bind_pose(const Character& character) {
  const Skeleton& skeleton = character.skeleton;
  Pose pose = rest_pose(skeleton);
  std::vector<char> done(pose.size(), 0);
  for (const Skin& skin : character.skins) {
    std::vector<int> place(pose.size(), -1);
    for (std::size_t j = 0; j < skin.joints.size() && j < skin.inverse_bind.size(); ++j)
      place[skin.joints[j]] = static_cast<int>(j);
    for (const int node : skin.joints) {
      const int parent = skeleton.nodes[node].parent;
      if (done[node] || parent < 0 || place[node] < 0 || place[parent] < 0) continue;
      const Affine& node_from_mesh = skin.inverse_bind[place[node]];
      if (std::abs(node_from_mesh.linear().determinant()) < 1e-30) continue;
      const Affine local = skin.inverse_bind[place[parent]] * node_from_mesh.inverse();
      pose[node].rotation = rotation_part(local.linear());
      pose[node].translation = local.translation();
      done[node] = 1;
    }
  }
  return pose;
}

/// Turned upright where the figure leans against every axis of the file (an armature with a rotation of its
/// own).
Reference upright(const Character& character, const Humanoid& humanoid, Pose pose, const Vec3& up) {
  const Vec3 rise = Landmarks(character, humanoid, pose).rise();
  if (angle(rise, up) < radians(25)) return {std::move(pose), up, false};
  const Vec3 stands = character.format == SourceFormat::gltf ? Vec3(Vec3::UnitY()) : up;
  return {turned(character, std::move(pose), shortest_rotation(rise, stands)), stands, false};
}

/// A bind pose leans like the rest pose above it: its legs are straight, so the whole figure is turned.
Pose standing_straight(const Character& character, const Humanoid& humanoid, Pose bind, const Vec3& up) {
  const Vec3 rise = Landmarks(character, humanoid, bind).rise();
  return angle(rise, up) < radians(5) ? bind
                                      : turned(character, std::move(bind), shortest_rotation(rise, up));
}

/// A rest pose is as good as the neutral pose when the legs are straight and the arms straight.
bool clean(const Landmarks& figure, const Vec3& up) {
  return usable(figure) && class_of(figure, up) != RestPoseClass::other && leg_tilt(figure, up) < radians(15);
}

/// The zero pose where it is one, but rather a T-pose that the first frame holds than one with spread legs;
/// else the best frame.
Reference reference_of_motion(const Character& character, const Humanoid& humanoid) {
  const Pose rest = rest_pose(character.skeleton);
  const Landmarks figure(character, humanoid, rest);
  const Vec3 rest_up = dominant_axis(figure.rise());
  const Vec3 up = up_of_motion(character, humanoid);
  const bool pose_of_nobody = !usable(figure) || class_of(figure, rest_up) == RestPoseClass::other;
  if (pose_of_nobody) return best_frame(character, humanoid, up);
  if (leg_tilt(figure, rest_up) > radians(12)) {
    const Pose first = sample(character.skeleton, character.animations[0], character.animations[0].start_s);
    if (exact_t_pose(Landmarks(character, humanoid, first), up)) return {first, up, false};
  }
  return {up == rest_up ? rest : turned(character, rest, shortest_rotation(rest_up, up)), up, false};
}

}  // namespace

bool only_motion(const Character& character) {
  return character.parts.empty() && !character.animations.empty() && !character.animations[0].tracks.empty();
}

Reference find_reference(const Character& character, const Humanoid& humanoid) {
  if (only_motion(character)) return reference_of_motion(character, humanoid);
  const Pose rest = rest_pose(character.skeleton);
  const Landmarks figure(character, humanoid, rest);
  const Vec3 up = dominant_axis(figure.rise());
  if (!clean(figure, up)) {
    const Pose bind = bind_pose(character);
    const Landmarks bound(character, humanoid, bind);
    const Vec3 bind_up = dominant_axis(bound.rise());
    const bool better = usable(bound) && class_of(bound, bind_up) != RestPoseClass::other &&
                        leg_tilt(bound, bind_up) < leg_tilt(figure, up);
    if (better) return {standing_straight(character, humanoid, bind, bind_up), bind_up, false};
  }
  const bool has_motion = !character.animations.empty() && !character.animations[0].tracks.empty();
  if (usable(figure) || !has_motion) return upright(character, humanoid, rest, up);
  return best_frame(character, humanoid, up_of_motion(character, humanoid));
}

}  // namespace ukemi
