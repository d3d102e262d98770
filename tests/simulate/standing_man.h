// A man of average proportions, built without a file: upright, arms hanging, every joint in its neutral pose.
#pragma once

#include <gtest/gtest.h>

#include "body/body.h"
#include "humanoid/rotations.h"
#include "restrict/range_of_motion.h"
#include "support/limp_run.h"

namespace ukemi::test {

struct StandingMan {
  BodyPose segments;
  ArticulatedBody body;
  RangeOfMotion range;

  explicit StandingMan(const std::string& region = "human") {
    place(Segment::pelvis, {0.0, 0.92, 0.0});
    place(Segment::abdomen, {0.0, 1.02, 0.0});
    place(Segment::chest, {0.0, 1.20, 0.0});
    place(Segment::head, {0.0, 1.50, 0.0});
    for (const double side : {-1.0, 1.0}) {
      const int arm = side < 0 ? index(Segment::clavicle_l) : index(Segment::clavicle_r);
      const int leg = side < 0 ? index(Segment::thigh_l) : index(Segment::thigh_r);
      place(segment_at(arm), {0.02, 1.44, side * 0.03});
      place(segment_at(arm + 1), {0.0, 1.43, side * 0.19});
      place(segment_at(arm + 2), {0.0, 1.14, side * 0.21});
      place(segment_at(arm + 3), {0.02, 0.87, side * 0.22});
      place(segment_at(leg), {0.0, 0.92, side * 0.09});
      place(segment_at(leg + 1), {0.01, 0.50, side * 0.09});
      place(segment_at(leg + 2), {0.0, 0.07, side * 0.09});
    }
    Character character;
    character.skeleton.nodes.push_back({"root", -1, {}});
    EXPECT_TRUE(character.skeleton.sort());
    Humanoid humanoid;
    humanoid.height_m = 1.75;
    for (SegmentNodes& nodes : humanoid.segments) nodes.chain = {0};
    Diagnostics diagnostics;
    auto built = build_body(character, humanoid, rest_pose(character.skeleton), segments, {}, diagnostics);
    EXPECT_TRUE(built);
    body = *built;
    auto loaded = load_range_of_motion(region);
    EXPECT_TRUE(loaded);
    range = *loaded;
    const auto charts = charts_of(range, rotations_of(segments));
    for (int j = 0; j < kJointCount; ++j) widen_to_hold(range.joints[j], charts[j], radians(3.0));
  }

  StartState start() const {
    StartState state;
    state.segments = segments;
    return state;
  }

  void place(Segment s, const Vec3& at) { segments[index(s)] = {Quat::Identity(), at}; }
};

inline SimulationResult run(const StandingMan& man, const Scene& scene, const SimulationSettings& settings) {
  Diagnostics diagnostics;
  auto result = simulate_limp(man.body, man.range, man.start(), scene, settings, diagnostics);
  EXPECT_TRUE(result) << result.error().message();
  return result ? std::move(*result) : SimulationResult{};
}

}  // namespace ukemi::test
