#include "prepare/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "base/animation.h"
#include "base/errors.h"
#include "base/native_rate.h"
#include "body/on_ground.h"
#include "clip/names.h"
#include "clip/start.h"
#include "humanoid/transfer.h"
#include "load/load.h"

namespace ukemi {
namespace {

constexpr double kMostKeys_hz = 60.0;
constexpr std::array<std::string_view, 7> kExtensions = {".bvh",  ".glb", ".gltf", ".vrm",
                                                         ".vrma", ".fbx", ".dae"};

bool ends_like(std::string_view text, std::string_view ending) {
  if (text.size() <= ending.size()) return false;
  return std::equal(ending.begin(), ending.end(), text.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); });
}

bool is_motion_file(std::string_view file) {
  return std::any_of(kExtensions.begin(), kExtensions.end(),
                     [&](std::string_view extension) { return ends_like(file, extension); });
}

/// A file and the clip after '#'.
struct FileAndClip {
  std::string file;
  std::optional<std::string> clip;
};

std::optional<FileAndClip> split(std::string_view text) {
  if (is_motion_file(text)) return FileAndClip{std::string(text), std::nullopt};
  for (std::size_t hash = text.find('#'); hash != text.npos; hash = text.find('#', hash + 1))
    if (is_motion_file(text.substr(0, hash)))
      return FileAndClip{std::string(text.substr(0, hash)), std::string(text.substr(hash + 1))};
  return std::nullopt;
}

/// A loaded file, mapped, and which of its clips is meant; none in a file without clips.
struct Source {
  Character character;
  Humanoid humanoid;
  std::optional<std::size_t> clip;
};

/// "#2" and "2" mean the third clip where none has that name.
Result<std::size_t> clip_in(const Character& character, const std::string& name) {
  const bool digits = !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
  const auto named = find_clip(character, name);
  return !named && digits ? find_clip(character, "#" + name) : named;
}

/// The character's bones by name, where the other file has them all: the same bones, whatever their
/// shape says. Else empty.
std::map<std::string, std::string> bones_by_name(const Character& character, const Humanoid& humanoid,
                                                 const Character& other) {
  std::map<std::string, std::string> map;
  const std::map<std::string, int> theirs = nodes_by_plain_name(other.skeleton);
  for (int s = 0; s < kSegmentCount; ++s) {
    if (humanoid.segments[s].fused()) continue;
    const std::string& bone = character.skeleton.nodes[humanoid.segments[s].node()].name;
    const auto found = theirs.find(plain_name(bone));
    if (bone.empty() || found == theirs.end() || found->second < 0) return {};
    map[std::string(name(segment_at(s)))] = other.skeleton.label(found->second);
  }
  return map;
}

/// By the character's own bones where the names are equal, else by what the file says.
Result<Humanoid> humanoid_of(const Character& character, const Humanoid& humanoid, const Character& other,
                             Diagnostics& diagnostics) {
  HumanoidOptions options;
  options.map = bones_by_name(character, humanoid, other);
  if (!options.map.empty()) {
    Diagnostics said;
    auto found = map_humanoid(other, options, said);
    if (found) {
      for (const Warning& warning : said.warnings()) diagnostics.warn(warning.subject, warning.what);
      return found;
    }
  }
  return map_humanoid(other, HumanoidOptions{}, diagnostics);
}

Result<Source> open(const Character& mine, const Humanoid& my_humanoid, const std::string& text,
                    Diagnostics& diagnostics) {
  const auto wanted = split(text);
  const FileAndClip what = wanted.value_or(FileAndClip{text, std::nullopt});
  auto character = load_character(what.file, LoadOptions{}, diagnostics);
  if (!character) return character.error();
  auto humanoid = humanoid_of(mine, my_humanoid, *character, diagnostics);
  if (!humanoid) return humanoid.error();
  Source source{std::move(*character), std::move(*humanoid), std::nullopt};
  if (what.clip) {
    const auto clip = clip_in(source.character, *what.clip);
    if (!clip) return clip.error();
    source.clip = *clip;
  } else if (!source.character.animations.empty()) {
    source.clip = 0;
  }
  return source;
}

/// Times from 0 to the end of the clip, on its own frames where those are at most 60 a second.
std::vector<double> key_times(const Animation& animation) {
  const double native = native_rate(animation);
  const double rate = native > 0.0 ? native / std::ceil(native / kMostKeys_hz - 1e-6) : kMostKeys_hz;
  std::vector<double> times;
  const double duration_s = animation.duration_s();
  for (int i = 0; i / rate < duration_s - 0.5 / kMostKeys_hz; ++i) times.push_back(i / rate);
  if (times.empty() || duration_s > 0.0) times.push_back(duration_s);
  return times;
}

/// Tracks of every node that is ever elsewhere than at rest.
Animation animation_of(const Skeleton& skeleton, const std::vector<double>& times,
                       const std::vector<Pose>& poses) {
  Animation animation;
  animation.end_s = times.back();
  for (int i = 0; i < skeleton.size(); ++i) {
    const LocalTransform& rest = skeleton.nodes[i].rest;
    Track rotation{i, TrackPath::rotation, Interpolation::linear, times, {}};
    Track translation{i, TrackPath::translation, Interpolation::linear, times, {}};
    bool turns = false, moves = false;
    for (const Pose& pose : poses) {
      const Quat& q = pose[i].rotation;
      const Vec3& t = pose[i].translation;
      rotation.values.insert(rotation.values.end(), {q.x(), q.y(), q.z(), q.w()});
      translation.values.insert(translation.values.end(), {t.x(), t.y(), t.z()});
      turns = turns || !(q.coeffs() == rest.rotation.coeffs());
      moves = moves || t != rest.translation;
    }
    if (turns) animation.tracks.push_back(std::move(rotation));
    if (moves) animation.tracks.push_back(std::move(translation));
  }
  return animation;
}

Vec3 pelvis_of(const Character& character, const Humanoid& humanoid, const Pose& pose) {
  return segments_of(character.skeleton, humanoid, pose)[index(Segment::pelvis)].translation;
}

/// A file that holds the clip, or any.
Result<Source> open_with_clip(const Character& character, const Humanoid& humanoid, const std::string& text,
                              Diagnostics& diagnostics) {
  auto source = open(character, humanoid, text, diagnostics);
  if (source && !source->clip)
    return input_error(source->character.path, "holds no clip",
                       "name a file with a clip, or use it as --pose");
  return source;
}

/// A clip of another file as motion of the character.
Animation motion_of(const Character& character, const Humanoid& humanoid, const Source& source,
                    std::size_t which) {
  const Animation& clip = source.character.animations[which];
  const Transfer transfer(character, humanoid, source.character, source.humanoid);
  const std::vector<double> times = key_times(clip);
  std::vector<Pose> poses;
  for (const double time_s : times)
    poses.push_back(transfer(sample(source.character.skeleton, clip, clip.start_s + time_s)));
  Vec3 offset =
      pelvis_of(character, humanoid, humanoid.reference) - pelvis_of(character, humanoid, poses.front());
  offset.y() = -floor_of(character, humanoid, poses);
  for (Pose& pose : poses) pose = moved(character.skeleton, humanoid, pose, offset);
  Animation animation = animation_of(character.skeleton, times, poses);
  animation.name =
      fmt::format("{}: {}", source.character.path.filename().string(), clip_label(source.character, which));
  animation.fps = clip.fps;
  return animation;
}

}  // namespace

bool names_motion_file(std::string_view text) { return split(text).has_value(); }

Result<Animation> motion_of_file(const Character& character, const Humanoid& humanoid,
                                 const std::string& text, Diagnostics& diagnostics) {
  const auto source = open_with_clip(character, humanoid, text, diagnostics);
  if (!source) return source.error();
  return motion_of(character, humanoid, *source, *source->clip);
}

Result<std::vector<Animation>> motions_of_file(const Character& character, const Humanoid& humanoid,
                                               const std::string& text, Diagnostics& diagnostics) {
  const auto source = open_with_clip(character, humanoid, text, diagnostics);
  if (!source) return source.error();
  std::vector<Animation> motions;
  const auto wanted = split(text);
  if (wanted && wanted->clip) {
    motions.push_back(motion_of(character, humanoid, *source, *source->clip));
    return motions;
  }
  for (std::size_t clip = 0; clip < source->character.animations.size(); ++clip)
    motions.push_back(motion_of(character, humanoid, *source, clip));
  return motions;
}

Animation going_on(const Skeleton& skeleton, const Humanoid& humanoid, const Animation& clip,
                   const Vec2& velocity) {
  std::vector<double> times = key_times(clip);
  std::vector<Pose> poses;
  for (double& time_s : times) {
    const Pose pose = sample(skeleton, clip, clip.start_s + time_s);
    poses.push_back(moved(skeleton, humanoid, pose, at_height(time_s * velocity, 0.0)));
    time_s += clip.start_s;
  }
  Animation result = clip;
  for (int i = 0; i < skeleton.size(); ++i) {
    if (skeleton.nodes[i].parent >= 0) continue;
    std::erase_if(result.tracks, [&](const Track& track) {
      return track.node == i && track.path == TrackPath::translation;
    });
    Track track{i, TrackPath::translation, Interpolation::linear, times, {}};
    for (const Pose& pose : poses) {
      const Vec3& t = pose[i].translation;
      track.values.insert(track.values.end(), {t.x(), t.y(), t.z()});
    }
    result.tracks.push_back(std::move(track));
  }
  return result;
}

Result<Pose> pose_of_file(const Character& character, const Humanoid& humanoid, const std::string& text,
                          Diagnostics& diagnostics) {
  const auto source = open(character, humanoid, text, diagnostics);
  if (!source) return source.error();
  const Transfer transfer(character, humanoid, source->character, source->humanoid);
  Pose pose = rest_pose(source->character.skeleton);
  if (source->clip) {
    const Animation& clip = source->character.animations[*source->clip];
    pose = sample(source->character.skeleton, clip, clip.start_s);
  }
  const Pose placed = transfer(pose);
  Vec3 offset = pelvis_of(character, humanoid, humanoid.reference) - pelvis_of(character, humanoid, placed);
  offset.y() = 0.0;
  return stand_on_floor(character, humanoid, moved(character.skeleton, humanoid, placed, offset));
}

}  // namespace ukemi
