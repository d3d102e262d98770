#include "check/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "bake/bake.h"
#include "base/animation.h"
#include "base/character_path.h"
#include "base/native_rate.h"
#include "base/quantile.h"
#include "check/inspect.h"
#include "load/load.h"

namespace ukemi {
namespace {

constexpr double kCutoff_hz = 12.0;
constexpr double kShare = 0.99;
constexpr double kLeast_s = 2.0;  // for a percentile that counts
constexpr double kStep = 5.0;     // thresholds are multiples of it, degrees per second
constexpr double kLowestRate = 24.0, kHighestRate = 120.0;

/// Absolute speeds of each axis, degrees per second.
using Pool = std::array<std::vector<TimedValue>, 3>;

using Pools = PerJoint<Pool>;

double duration_of(const Pool& pool) {
  double seconds = 0.0;
  for (const TimedValue& value : pool[0]) seconds += value.seconds;
  return seconds;
}

Vec3 upper_speeds(const Pool& pool) {
  if (duration_of(pool) < kLeast_s) return Vec3::Zero();
  return {quantile_of_time(pool[0], kShare), quantile_of_time(pool[1], kShare),
          quantile_of_time(pool[2], kShare)};
}

/// The joint that stands for both sides.
Joint pooled(Joint joint) { return is_left(joint) ? mirror_of(joint) : joint; }

void pool_frames(const JointSpeeds& clip, Activity activity, Pools& pools) {
  for (int j = 0; j < kJointCount; ++j) {
    Pool& pool = pools[index(pooled(joint_at(j)))];
    for (std::size_t f = 0; f < clip.speeds[j].size(); ++f) {
      if (clip.glitch[j][f] || clip.activity[f] != activity) continue;
      for (int axis = 0; axis < 3; ++axis)
        pool[axis].push_back({degrees(std::abs(clip.speeds[j][f][axis])), 1.0 / clip.fps});
    }
  }
}

/// Frames of calm standing of all clips, and what walking asks for.
class Measurement {
 public:
  Status add_file(const std::string& file, bool with_walking, const RangeOfMotion& range,
                  Diagnostics& diagnostics);
  void report(Calibration& calibration) const;

 private:
  void add_walk(const JointSpeeds& clip);

  Pools standing_;
  PerJoint<double> walking_s_{};
  PerJoint<Vec3> walking_p99_ = [] {
    PerJoint<Vec3> zero;
    zero.fill(Vec3::Zero());
    return zero;
  }();
};

void Measurement::add_walk(const JointSpeeds& clip) {
  Pools walking;
  pool_frames(clip, Activity::walking, walking);
  for (int j = 0; j < kJointCount; ++j) {
    walking_s_[j] += duration_of(walking[j]);
    walking_p99_[j] = walking_p99_[j].cwiseMax(upper_speeds(walking[j]));
  }
}

Status Measurement::add_file(const std::string& file, bool with_walking, const RangeOfMotion& range,
                             Diagnostics& diagnostics) {
  const auto path = character_path(file);
  if (!path) return path.error();
  const auto character = load_character(*path, LoadOptions{}, diagnostics);
  if (!character) return character.error();
  const auto humanoid = map_humanoid(*character, HumanoidOptions{}, diagnostics);
  if (!humanoid) return humanoid.error();
  for (const Animation& animation : character->animations) {
    const double rate = std::clamp(native_rate(animation), kLowestRate, kHighestRate);
    const Clip clip = sample_clip(character->skeleton, animation, rate);
    const JointSpeeds speeds = joint_speeds(character->skeleton, *humanoid, range, clip, kCutoff_hz);
    pool_frames(speeds, Activity::standing, standing_);
    if (with_walking) add_walk(speeds);
  }
  return Done{};
}

void Measurement::report(Calibration& calibration) const {
  for (int j = 0; j < kJointCount; ++j) {
    const int from = index(pooled(joint_at(j)));
    calibration.standing_s[j] = duration_of(standing_[from]);
    calibration.walking_s[j] = walking_s_[from];
    calibration.standing_p99[j] = upper_speeds(standing_[from]);
    calibration.walking_p99[j] = walking_p99_[from];
  }
}

double threshold(const CalibrationSettings& settings, double standing, double walking) {
  const double least = std::max(settings.factor * standing, settings.walking ? walking : 0.0);
  return std::max(kThresholdFloor, kStep * std::ceil(least / kStep - 1e-9));
}

std::string side_free(Joint joint) {
  const std::string_view text = name(joint);
  return std::string(text.ends_with("_r") ? text.substr(0, text.size() - 2) : text);
}

/// "# a, b, c" broken into lines.
std::string comment_lines(const std::vector<std::string>& words) {
  std::string text, line = "#";
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = " " + words[i] + (i + 1 < words.size() ? "," : "");
    if (line.size() + word.size() > 110) {
      text += line + "\n";
      line = "#";
    }
    line += word;
  }
  return text + line + "\n";
}

std::string numbers(const Vec3& v, int decimals) {
  return fmt::format("{:.{}f}, {:.{}f}, {:.{}f}", v[0], decimals, v[1], decimals, v[2], decimals);
}

}  // namespace

Result<Calibration> calibrate(const CalibrationSettings& settings, Diagnostics& diagnostics) {
  const auto range = load_range_of_motion("human");
  if (!range) return range.error();
  std::vector<std::string> files = {"mannequin"};
  files.insert(files.end(), settings.files.begin(), settings.files.end());
  Calibration calibration;
  calibration.settings = settings;
  Measurement measurement;
  const auto add_files = [&](const std::vector<std::string>& added, bool with_walking) -> Status {
    for (const std::string& file : added) {
      const Status status = measurement.add_file(file, with_walking, *range, diagnostics);
      if (!status) return status.error();
      const std::string source = std::filesystem::path(file).filename().string();
      calibration.sources.push_back(with_walking ? source : source + " (standing)");
    }
    return Done{};
  };
  if (const Status status = add_files(files, settings.walking); !status) return status.error();
  if (const Status status = add_files(settings.standing_files, false); !status) return status.error();
  measurement.report(calibration);
  for (int j = 0; j < kJointCount; ++j)
    for (int axis = 0; axis < 3; ++axis)
      calibration.thresholds[j][axis] =
          threshold(settings, calibration.standing_p99[j][axis], calibration.walking_p99[j][axis]);
  return calibration;
}

std::string calibration_toml(const Calibration& calibration) {
  const CalibrationSettings& settings = calibration.settings;
  std::string text =
      "# Thresholds of the active restriction, degrees per second: [a_y, a_z, alpha] of each joint (left = "
      "right).\n"
      "# It acts on an axis while the joint turns faster about it (Era et al., section 4.2).\n";
  text +=
      fmt::format("# {:g} times the 99th percentile of calm standing{}, at least {:g},\n", settings.factor,
                  settings.walking ? ", at least that of every walk" : "", kThresholdFloor);
  text += "# rounded up to 5; zero-phase low-pass at 12 Hz. Measured by ukemi calibrate on:\n";
  text += comment_lines(calibration.sources);
  text += "format = 1\nunits = \"deg/s\"\n\n[threshold]\n";
  for (int j = 0; j < kJointCount; ++j) {
    if (is_left(joint_at(j))) continue;
    text += fmt::format("# 99 %: standing [{}] in {:.0f} s", numbers(calibration.standing_p99[j], 1),
                        calibration.standing_s[j]);
    if (settings.walking)
      text += fmt::format(", walking [{}] in {:.0f} s", numbers(calibration.walking_p99[j], 1),
                          calibration.walking_s[j]);
    text += fmt::format("\n{} = [{}]\n", side_free(joint_at(j)), numbers(calibration.thresholds[j], 0));
  }
  return text;
}

std::string calibration_text(const Calibration& calibration) {
  std::string text =
      fmt::format("{:<9} {:>26} {:>26} {:>20}\n", "deg/s", "standing 99 %", "walking 99 %", "threshold");
  for (int j = 0; j < kJointCount; ++j) {
    if (is_left(joint_at(j))) continue;
    text += fmt::format("{:<9} {:>26} {:>26} {:>20}\n", side_free(joint_at(j)),
                        numbers(calibration.standing_p99[j], 1), numbers(calibration.walking_p99[j], 1),
                        numbers(calibration.thresholds[j], 0));
  }
  return text + fmt::format("{:.0f} s of calm standing, {:.0f} s of walking (both sides of a limb)\n",
                            calibration.standing_s[index(Joint::hip_r)],
                            calibration.walking_s[index(Joint::hip_r)]);
}

}  // namespace ukemi
