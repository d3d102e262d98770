#include "prepare/in_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/animation.h"
#include "base/quantile.h"
#include "body/on_ground.h"
#include "humanoid/soles.h"

namespace ukemi {
namespace {

constexpr double kRate_hz = 60.0;
constexpr int kMostSamples = 600;
constexpr double kDown = 0.35;        // share of the time in which the foot of a gait is down at the least
constexpr double kLifted = 0.03;      // of the height: a foot that steps
constexpr double kSlowest_m_s = 0.4;  // of a man of 1.75 m: slower feet only slip
constexpr double kAlike = 0.4;        // of the speed, between the feet
constexpr double kBack = 0.3, kMostBack = 0.5;  // of the speed: a slide goes back; share of slides that do
constexpr double kGoesItself = 0.25;            // of that speed, by the pelvis

struct Sample {
  std::array<std::vector<Vec3>, 2> soles;
  Vec2 pelvis;
};

std::vector<Sample> samples_of(const Character& character, const Humanoid& humanoid, const Animation& clip,
                               double step_s) {
  const Soles soles(character, humanoid);
  std::vector<Sample> samples;
  for (int i = 0; i * step_s < clip.duration_s() + 1e-6; ++i) {
    const Pose pose = sample(character.skeleton, clip, clip.start_s + i * step_s);
    const BodyPose body = segments_of(character.skeleton, humanoid, pose);
    samples.push_back(
        {soles.points(character.skeleton, pose), on_ground(body[index(Segment::pelvis)].translation)});
  }
  return samples;
}

const Vec3& lowest_of(const std::vector<Vec3>& points) {
  return *std::min_element(points.begin(), points.end(), [](auto& a, auto& b) { return a.y() < b.y(); });
}

/// Velocities of the sole of a foot where it is down; none of a foot that is never lifted.
std::vector<Vec2> slides_of(const std::vector<Sample>& samples, int side, double height_m, double step_s) {
  std::vector<double> heights;
  for (const Sample& at : samples) heights.push_back(lowest_of(at.soles[side]).y());
  const auto [least, most] = std::minmax_element(heights.begin(), heights.end());
  if (*most - *least < kLifted * height_m) return {};
  const auto rank = static_cast<std::size_t>(kDown * static_cast<double>(heights.size() - 1));
  const double down = ranked(std::vector<double>(heights), rank);
  std::vector<Vec2> slides;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (std::max(heights[i - 1], heights[i]) > down) continue;
    const std::vector<Vec3>& is = samples[i].soles[side];
    const auto point = static_cast<std::size_t>(&lowest_of(is) - is.data());
    slides.push_back(on_ground(is[point] - samples[i - 1].soles[side][point]) / step_s);
  }
  return slides;
}

Vec2 mean_of(const std::vector<Vec2>& velocities) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& velocity : velocities) sum += velocity;
  return sum / static_cast<double>(velocities.size());
}

}  // namespace

std::optional<Vec2> gait_in_place(const Character& character, const Humanoid& humanoid,
                                  const Animation& clip) {
  const double step_s = std::max(1.0 / kRate_hz, clip.duration_s() / kMostSamples);
  const std::vector<Sample> samples = samples_of(character, humanoid, clip, step_s);
  if (samples.size() < 10) return std::nullopt;
  std::vector<Vec2> all;
  std::array<Vec2, 2> of_foot;
  for (int side = 0; side < 2; ++side) {
    const std::vector<Vec2> slides = slides_of(samples, side, humanoid.height_m, step_s);
    if (slides.size() < 4) return std::nullopt;
    of_foot[side] = mean_of(slides);
    all.insert(all.end(), slides.begin(), slides.end());
  }
  const Vec2 slide = 0.5 * (of_foot[0] + of_foot[1]);
  const double speed = slide.norm();
  const double way_s = step_s * static_cast<double>(samples.size() - 1);
  const auto back = std::count_if(all.begin(), all.end(), [&](const Vec2& velocity) {
    return velocity.dot(slide) > kBack * speed * speed;
  });
  const bool gait = speed > kSlowest_m_s * std::sqrt(humanoid.height_m / 1.75) &&
                    (of_foot[0] - of_foot[1]).norm()<kAlike * speed&& static_cast<double>(back)> kMostBack *
                        static_cast<double>(all.size());
  const bool goes = (samples.back().pelvis - samples.front().pelvis).norm() > kGoesItself * speed * way_s;
  if (!gait || goes) return std::nullopt;
  // While a foot rolls over heel and toes its sole is slower than the ground.
  std::vector<double> speeds;
  for (const Vec2& velocity : all) speeds.push_back(velocity.dot(slide) / speed);
  return -quantile(std::move(speeds), 0.5) / speed * slide;
}

}  // namespace ukemi
