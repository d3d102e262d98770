#include "prepare/get_up_clips.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "base/animation.h"
#include "base/errors.h"
#include "prepare/motion.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;

constexpr double kRate_hz = 60.0;
constexpr std::size_t kNamed = 8;  // clips that a message lists

constexpr const char* kFix =
    "name a clip in which somebody lies, sits or kneels on the floor and gets up (ukemi inspect FILE lists "
    "the clips)";

std::vector<RisingClip> get_ups_in(const Character& character, const Humanoid& humanoid,
                                   const ArticulatedBody& body, const Animation& motion) {
  const Clip clip = sample_clip(character.skeleton, motion, kRate_hz);
  std::vector<BodyPose> frames;
  for (const Pose& pose : clip.frames)
    frames.push_back(canonical_segments_of(character.skeleton, humanoid, pose));
  return rising_clips_of(body, motion.name, clip.fps, frames);
}

/// What a file holds: its get-ups, and the names of its clips.
struct FoundGetUps {
  std::vector<RisingClip> get_ups;
  std::vector<std::string> looked_at;
};

Result<FoundGetUps> find_in_file(const Character& character, const Humanoid& humanoid,
                                 const ArticulatedBody& body, const std::string& text,
                                 Diagnostics& diagnostics) {
  const auto motions = motions_of_file(character, humanoid, text, diagnostics);
  if (!motions) return motions.error();
  FoundGetUps found;
  for (const Animation& motion : *motions) {
    found.looked_at.push_back(motion.name);
    auto get_ups = get_ups_in(character, humanoid, body, motion);
    std::move(get_ups.begin(), get_ups.end(), std::back_inserter(found.get_ups));
  }
  return found;
}

Error nobody_gets_up(const std::string& text, const std::vector<std::string>& looked_at) {
  const std::vector<std::string> first(
      looked_at.begin(), looked_at.begin() + static_cast<std::ptrdiff_t>(std::min(looked_at.size(), kNamed)));
  return input_error(
      text,
      fmt::format("nobody gets up from the floor in it: looked at {}{}", fmt::join(first, ", "),
                  looked_at.size() > kNamed ? fmt::format(" and {} more", looked_at.size() - kNamed) : ""),
      kFix);
}

Result<std::vector<fs::path>> motion_files_in(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file() && names_motion_file(entry.path().string())) files.push_back(entry.path());
  if (error) return input_error(folder, fmt::format("cannot be read: {}", error.message()), kFix);
  if (files.empty())
    return input_error(folder, "holds no file with motion", "name a folder with .bvh, .glb or .fbx files");
  std::sort(files.begin(), files.end());
  return files;
}

Result<FoundGetUps> find_in_folder(const Character& character, const Humanoid& humanoid,
                                   const ArticulatedBody& body, const std::string& folder,
                                   Diagnostics& diagnostics) {
  const auto files = motion_files_in(folder);
  if (!files) return files.error();
  FoundGetUps all;
  for (const fs::path& file : *files) {
    auto found = find_in_file(character, humanoid, body, file.string(), diagnostics);
    if (!found) {
      diagnostics.warn(file.string(), fmt::format("left out of --get-up-clip: {}", found.error().what));
      continue;
    }
    std::move(found->get_ups.begin(), found->get_ups.end(), std::back_inserter(all.get_ups));
    all.looked_at.insert(all.looked_at.end(), found->looked_at.begin(), found->looked_at.end());
  }
  return all;
}

}  // namespace

Result<std::vector<RisingClip>> get_up_clips(const Character& character, const Humanoid& humanoid,
                                             const ArticulatedBody& body, const std::string& text,
                                             Diagnostics& diagnostics) {
  std::error_code error;
  auto found = fs::is_directory(text, error) ? find_in_folder(character, humanoid, body, text, diagnostics)
                                             : find_in_file(character, humanoid, body, text, diagnostics);
  if (!found) return found.error();
  if (found->get_ups.empty()) return nobody_gets_up(text, found->looked_at);
  return std::move(found->get_ups);
}

}  // namespace ukemi
