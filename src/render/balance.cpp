#include "render/balance.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "body/centre_of_mass.h"
#include "body/on_ground.h"
#include "body/sole.h"

namespace ukemi {
namespace {

constexpr Segment kFeet[] = {Segment::foot_l, Segment::foot_r};
constexpr double kOnFloor_m = 0.03;     // lowest corner of a sole that stands
constexpr double kStill_m_s = 0.25;     // of it
constexpr double kShortest_s = 0.08;    // that a foot stands for a print
constexpr double kOtherPlace_m = 0.03;  // from the last print
constexpr double kGravity = 9.81;
constexpr double kPrint_m = 0.003, kSupport_m = 0.005, kPoint_m = 0.007;  // above the floor
constexpr int kRound = 24;
const Rgba kLeft = srgb(0x2F6FD0, 0.55f), kRight = srgb(0xD0702B, 0.55f);
const Rgba kSupport = srgb(0x2E9B4F, 0.30f), kMass = srgb(0x222222), kCapture = srgb(0xC23B22);

Surface lying_on_floor() {
  Surface surface;
  surface.alpha = Material::Alpha::blend;
  surface.double_sided = true;
  surface.casts_shadow = false;
  surface.takes_shadow = false;
  surface.gloss = 0.0f;
  return surface;
}

void add_polygon(Geometry& geometry, const std::vector<Vec2>& corners, double height, const Rgba& color) {
  for (std::size_t i = 2; i < corners.size(); ++i)
    add_flat_triangle(
        geometry,
        {at_height(corners[0], height), at_height(corners[i - 1], height), at_height(corners[i], height)},
        color);
}

Vec2 on_circle(const Vec2& centre, double radius, int i) {
  const double turn = 2.0 * kPi * i / kRound;
  return centre + radius * Vec2(std::cos(turn), std::sin(turn));
}

void add_ring(Geometry& geometry, const Vec2& centre, double inner, double outer, const Rgba& color) {
  for (int i = 0; i < kRound; ++i) {
    const Vec3 a = at_height(on_circle(centre, inner, i), kPoint_m),
               b = at_height(on_circle(centre, outer, i), kPoint_m);
    const Vec3 c = at_height(on_circle(centre, outer, i + 1), kPoint_m);
    const Vec3 d = at_height(on_circle(centre, inner, i + 1), kPoint_m);
    add_flat_triangle(geometry, {a, b, c}, color);
    add_flat_triangle(geometry, {a, c, d}, color);
  }
}

std::array<Vec3, 4> corners_of(const BodyPose& pose, Segment foot, const std::array<Vec3, 4>& sole) {
  std::array<Vec3, 4> corners;
  for (std::size_t i = 0; i < sole.size(); ++i) corners[i] = pose[index(foot)] * sole[i];
  return corners;
}

/// The lowest corner is on the floor and slow.
bool stands_on(const std::array<Vec3, 4>& before, const std::array<Vec3, 4>& after, double span_s) {
  std::size_t lowest = 0;
  for (std::size_t i = 1; i < after.size(); ++i)
    if (after[i].y() < after[lowest].y()) lowest = i;
  return after[lowest].y() < kOnFloor_m && (after[lowest] - before[lowest]).norm() < kStill_m_s * span_s;
}

}  // namespace

FloorMarks::FloorMarks(const Shot& shot) {
  const std::vector<BodyPose>& poses = *shot.segments;
  const int frames = static_cast<int>(poses.size());
  stands_.resize(poses.size());
  for (int side = 0; side < 2; ++side) {
    soles_[side] =
        sole_of(shot.body->segments[index(kFeet[side])], poses.front()[index(kFeet[side])].rotation);
    const auto corners = [&](int f) { return corners_of(poses[f], kFeet[side], soles_[side]); };
    for (int f = 0; f < frames; ++f) {
      const int before = std::max(f - 1, 0), after = std::min(f + 1, frames - 1);
      stands_[f][side] =
          stands_on(corners(before), corners(after), std::max(after - before, 1) / shot.clip->fps);
    }
    std::optional<Vec2> last;
    for (int from = 0, to = 0; from < frames; from = std::max(to, from + 1)) {
      for (to = from; to < frames && stands_[to][side]; ++to) continue;
      if (to - from < kShortest_s * shot.clip->fps) continue;
      Corners print;
      const auto at = corners((from + to - 1) / 2);
      for (std::size_t i = 0; i < at.size(); ++i) print[i] = on_ground(at[i]);
      if (last && (print[0] - *last).norm() < kOtherPlace_m) continue;
      last = print[0];
      prints_.push_back({from, side == 0, print});
    }
  }
}

void FloorMarks::add_prints(Geometry& geometry, int frame) const {
  geometry.begin(lying_on_floor());
  for (const Print& print : prints_)
    if (print.frame <= frame)
      add_polygon(geometry, {print.corners.begin(), print.corners.end()}, kPrint_m,
                  print.left ? kLeft : kRight);
}

void FloorMarks::add_support(Geometry& geometry, const Shot& shot, int frame) const {
  const std::vector<BodyPose>& poses = *shot.segments;
  const int frames = static_cast<int>(poses.size());
  std::vector<Vec2> soles;
  for (int side = 0; side < 2; ++side)
    if (stands_[frame][side])
      for (const Vec3& corner : corners_of(poses[frame], kFeet[side], soles_[side]))
        soles.push_back(on_ground(corner));
  geometry.begin(lying_on_floor());
  if (!soles.empty()) add_polygon(geometry, convex_hull(std::move(soles)), kSupport_m, kSupport);
  const int before = std::max(frame - 1, 0), after = std::min(frame + 1, frames - 1);
  const Vec3 com = centre_of_mass(*shot.body, poses[frame]);
  const Vec3 velocity =
      (centre_of_mass(*shot.body, poses[after]) - centre_of_mass(*shot.body, poses[before])) *
      (shot.clip->fps / std::max(after - before, 1));
  const double size = shot.body->height_m / 1.75;
  add_ring(geometry, on_ground(com), 0.0, 0.018 * size, kMass);
  const Vec2 capture = on_ground(com) + on_ground(velocity) / std::sqrt(kGravity / std::max(com.y(), 0.1));
  add_ring(geometry, capture, 0.022 * size, 0.032 * size, kCapture);
}

}  // namespace ukemi
