#include "humanoid/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

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

/// "y", "-z"
std::string axis_name(const Vec3& axis) {
  int longest = 0;
  axis.cwiseAbs().maxCoeff(&longest);
  return std::string(axis[longest] < 0.0 ? "-" : "") + static_cast<char>('x' + longest);
}

/// The file's own word on its up axis: glTF 2.0 section 3.4 ("+Y is up"), or what an FBX, a DAE or a BVH of
/// this program states.
std::optional<Vec3> stated_up(const Character& character) {
  if (character.format == SourceFormat::gltf) return Vec3(Vec3::UnitY());
  if (character.yup_from_file) return character.yup_from_file->conjugate() * Vec3::UnitY();
  return std::nullopt;
}

double lowest_along(const Landmarks& figure, const Vec3& up) {
  double lowest = 1e300;
  for (const Vec3& origin : figure.origin) lowest = std::min(lowest, origin.dot(up));
  return lowest;
}

/// How well a motion fits an axis as up.
struct AxisReading {
  double standing = 0.0;      // share of the frames whose head is above the feet, within 45 degrees
  double floor = 0.0;         // mean height of the lowest joint over the origin, of the body's rise
  double floor_spread = 0.0;  // how far that height moves, of the body's rise
};

AxisReading read_axis(const std::vector<Landmarks>& figures, const Vec3& up) {
  AxisReading reading;
  double least = 1e300, most = -1e300, size = 0.0;
  for (const Landmarks& figure : figures) {
    const double lowest = lowest_along(figure, up);
    least = std::min(least, lowest);
    most = std::max(most, lowest);
    reading.floor += lowest;
    reading.standing += angle(figure.rise(), up) < radians(45) ? 1.0 : 0.0;
    size = std::max(size, figure.rise().norm());
  }
  const auto count = static_cast<double>(figures.size());
  reading.standing /= count;
  reading.floor /= count * size;
  reading.floor_spread = (most - least) / size;
  return reading;
}

bool on_the_floor(const AxisReading& reading) {
  return reading.floor > -0.05 && reading.floor < 0.2 && reading.floor_spread < 0.3;
}

/// True where the motion can only be understood with `other` up: the figure stands along it and hardly ever
/// along `expected`, and the floor of `expected` carries nothing.
bool contradicts(const AxisReading& expected, const AxisReading& other) {
  return expected.standing < 0.05 && other.standing > 0.6 && on_the_floor(other) && !on_the_floor(expected);
}

/// The up axis of a motion. Expected is that of the zero pose, else y as nearly all motion has it; a figure
/// that lies still, falls, or gets up contradicts nothing.
Vec3 up_of_motion(const Character& character, const Humanoid& humanoid, const Vec3& expected,
                  Diagnostics& diagnostics) {
  std::vector<Landmarks> figures;
  for (const double t : sample_times(character.animations[0], 100))
    figures.emplace_back(character, humanoid, sample(character.skeleton, character.animations[0], t));
  const AxisReading reading = read_axis(figures, expected);
  for (int axis = 0; axis < 6 && reading.standing < 0.05; ++axis) {
    const Vec3 other = (axis < 3 ? 1.0 : -1.0) * Vec3::Unit(axis % 3);
    const AxisReading along = read_axis(figures, other);
    if (other == expected || along.standing <= 0.6) continue;
    const bool taken = contradicts(reading, along);
    diagnostics.warn(
        character.path.string(),
        fmt::format("the figure never stands along {}, the up axis that its skeleton implies; up "
                    "is taken to be {}: --up sets it",
                    axis_name(expected), axis_name(taken ? other : expected)));
    return taken ? other : expected;
  }
  return expected;
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

/// Turned upright where the figure does not stand along `up` (an armature with a rotation of its own).
Reference upright(const Character& character, const Humanoid& humanoid, Pose pose, const Vec3& up) {
  const Vec3 rise = Landmarks(character, humanoid, pose).rise();
  if (angle(rise, up) < radians(25)) return {std::move(pose), up, false};
  const Vec3 axis = dominant_axis(rise);
  const Quat turn = shortest_rotation(angle(rise, axis) < radians(25) ? axis : rise, up);
  return {turned(character, std::move(pose), turn), up, false};
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
Reference reference_of_motion(const Character& character, const Humanoid& humanoid,
                              const std::optional<Vec3>& user, Diagnostics& diagnostics) {
  const Pose rest = rest_pose(character.skeleton);
  const Landmarks figure(character, humanoid, rest);
  const Vec3 rest_up = dominant_axis(figure.rise());
  const bool pose_of_nobody = !usable(figure) || class_of(figure, rest_up) == RestPoseClass::other;
  const bool zero_pose_stands = !pose_of_nobody && (rest_up.y() > 0.5 || rest_up.z() > 0.5);
  const auto stated = stated_up(character);
  const Vec3 implied = zero_pose_stands ? rest_up : Vec3(Vec3::UnitY());
  const bool is_certain = user || (stated && character.format != SourceFormat::assimp);
  const Vec3 up = is_certain ? (user ? *user : *stated)
                             : up_of_motion(character, humanoid, stated.value_or(implied), diagnostics);
  if (pose_of_nobody) return best_frame(character, humanoid, up);
  if (leg_tilt(figure, rest_up) > radians(12)) {
    const Pose first = sample(character.skeleton, character.animations[0], character.animations[0].start_s);
    if (exact_t_pose(Landmarks(character, humanoid, first), up)) return {first, up, false};
  }
  return {up == rest_up ? rest : turned(character, rest, shortest_rotation(rest_up, up)), up, false};
}

/// Up of a character that rests as `rise` says: the user's word, then that of a glTF; an FBX or DAE is
/// believed where its figure stands so.
Vec3 up_of_rest(const Character& character, const std::optional<Vec3>& user, const Vec3& rise,
                Diagnostics& diagnostics) {
  if (user) return *user;
  const auto stated = stated_up(character);
  const Vec3 guess = dominant_axis(rise);
  if (!stated || stated->dot(guess) > 0.9) return stated.value_or(guess);
  if (character.format == SourceFormat::gltf && angle(rise, guess) > radians(25)) return *stated;
  diagnostics.warn(character.path.string(),
                   character.format == SourceFormat::gltf
                       ? fmt::format("the rest pose stands along {}, not along y as glTF asks; it is turned "
                                     "upright: --up sets the up axis",
                                     axis_name(guess))
                       : "the character does not stand along the file's up axis; up is taken from its feet "
                         "to its head: --up sets it");
  return character.format == SourceFormat::gltf ? *stated : guess;
}

}  // namespace

bool only_motion(const Character& character) {
  return character.parts.empty() && !character.animations.empty() && !character.animations[0].tracks.empty();
}

Reference find_reference(const Character& character, const Humanoid& humanoid, const HumanoidOptions& options,
                         Diagnostics& diagnostics) {
  std::optional<Vec3> user;
  if (options.up_axis) user = Vec3::Unit(*options.up_axis - 'x');
  if (only_motion(character)) return reference_of_motion(character, humanoid, user, diagnostics);
  const Pose rest = rest_pose(character.skeleton);
  const Landmarks figure(character, humanoid, rest);
  const Vec3 rest_up = dominant_axis(figure.rise());
  if (!clean(figure, rest_up)) {
    const Pose bind = bind_pose(character);
    const Landmarks bound(character, humanoid, bind);
    const Vec3 bind_up = dominant_axis(bound.rise());
    const bool better = usable(bound) && class_of(bound, bind_up) != RestPoseClass::other &&
                        leg_tilt(bound, bind_up) < leg_tilt(figure, rest_up);
    if (better) {
      const Vec3 up = up_of_rest(character, user, bound.rise(), diagnostics);
      return {standing_straight(character, humanoid, bind, up), up, false};
    }
  }
  const bool has_motion = !character.animations.empty() && !character.animations[0].tracks.empty();
  if (usable(figure) || !has_motion)
    return upright(character, humanoid, rest, up_of_rest(character, user, figure.rise(), diagnostics));
  const auto known = user ? user : stated_up(character);
  return best_frame(character, humanoid,
                    known ? *known : up_of_motion(character, humanoid, Vec3::UnitY(), diagnostics));
}

}  // namespace ukemi
