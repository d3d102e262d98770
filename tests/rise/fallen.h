// Bodies that lie as a fall left them, and what a look at every frame of their get-up finds.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "bake/bake.h"
#include "base/character_path.h"
#include "body/ground.h"
#include "body/weight.h"
#include "load/load.h"
#include "prepare/direction.h"
#include "rise/get_up.h"
#include "rise/whole_body.h"

namespace ukemi {

inline constexpr double kAsHeLay_s = 0.3;  // in which a body still lies as the fall left it

struct Fallen {
  std::string what;
  ArticulatedBody body;
  RangeOfMotion range;
  OuterSkin skin;
  BodyPose before, lying, standing;
};

inline Fallen fallen(const Character& character, const std::string& what, const BakeSettings& settings) {
  Diagnostics diagnostics;
  auto outcome = bake(character, settings, diagnostics);
  EXPECT_TRUE(outcome) << what;
  if (!outcome) return {};
  const Prepared& prepared = outcome->prepared;
  const std::vector<BodyPose>& frames = outcome->timeline.trajectory.frames;
  return {what,
          prepared.body,
          prepared.range,
          outermost_skin(character, prepared.humanoid, prepared.start.pose, prepared.start.segments,
                         prepared.body),
          frames[frames.size() - 2],
          frames.back(),
          prepared.start.state.segments};
}

inline Character load(const std::string& file) {
  Diagnostics diagnostics;
  auto path = character_path(file);
  EXPECT_TRUE(path);
  auto character = load_character(*path, LoadOptions{}, diagnostics);
  EXPECT_TRUE(character) << file;
  return character ? std::move(*character) : Character{};
}

inline BakeSettings limp_fall(Segment hit, int azimuth) {
  BakeSettings settings;
  settings.behaviour = Behaviour::limp;
  settings.hit = hit;
  settings.from = *parse_direction(std::to_string(azimuth));
  settings.simulation.duration_s = 4.0;
  return settings;
}

inline BakeSettings living_fall(int azimuth) {
  BakeSettings settings;
  settings.preset = "kick";
  settings.strength = 2.0;
  settings.from = *parse_direction(std::to_string(azimuth));
  settings.most_steps = 0;
  settings.simulation.duration_s = 6.0;
  return settings;
}

/// What a frame-by-frame look at a get-up found, at worst.
struct Found {
  double excess_deg = 0.0, slide_m = 0.0, sunk_m = 0.0, off_balance_m = 0.0, step_m = 0.0;
};

inline Found look_at(const Fallen& man, const GetUp& get_up) {
  const WholeBody whole(man.body, man.range, man.skin);
  Found worst;
  const std::vector<WeightOffset> weights = weight_offsets(man.body, man.skin, get_up.frames, get_up.fps);
  for (std::size_t f = 1; f < get_up.frames.size(); ++f) {
    const BodyPose& frame = get_up.frames[f];
    PerSegment<Quat> rotations;
    for (int s = 0; s < kSegmentCount; ++s) rotations[s] = frame[s].rotation;
    const PerJoint<SwingTwist> charts = charts_of(man.range, rotations);
    for (int j = 0; j < kJointCount; ++j)
      if (!man.body.joints[j].fused)
        worst.excess_deg = std::max(worst.excess_deg, degrees(excess(man.range.joints[j], charts[j])));
    worst.sunk_m = std::max(worst.sunk_m, -whole.lowest(frame));
    for (int s = 0; s < kSegmentCount; ++s)
      worst.step_m =
          std::max(worst.step_m, (frame[s].translation - get_up.frames[f - 1][s].translation).norm());
    const int n = static_cast<int>(f);
    for (const PlantedPart& part : get_up.planted)
      if (n >= part.first && n <= part.last)
        worst.slide_m =
            std::max(worst.slide_m, (frame[index(part.segment)] * part.point - part.place).norm());
    if (n >= kAsHeLay_s * get_up.fps)
      worst.off_balance_m = std::max(worst.off_balance_m, weights[f].least_m());
  }
  return worst;
}

}  // namespace ukemi
