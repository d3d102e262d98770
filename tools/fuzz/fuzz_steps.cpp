// The whole path: bytes, character, humanoid, body, ten steps of a simulation.
#include <cmath>

#include "body/body.h"
#include "fuzz/checks.h"
#include "humanoid/humanoid.h"
#include "humanoid/rotations.h"
#include "load/load.h"
#include "behave/tone.h"

namespace {

using namespace ukemi;

constexpr int kMostNodes = 400;  // of a character that is worth the time

bool is_gltf(const std::uint8_t* data, std::size_t size) {
  return size > 0 && (data[0] == '{' || data[0] == 'g');
}

Result<Character> read(const std::uint8_t* data, std::size_t size, Diagnostics& diagnostics) {
  if (is_gltf(data, size)) return read_gltf({data, size}, "folder/input.glb", diagnostics);
  return read_bvh(fuzz::text_of(data, size), "folder/input.bvh", diagnostics);
}

const RangeOfMotion& human_range() {
  static const RangeOfMotion range = *load_range_of_motion("human");
  return range;
}

void require_finite(const SimulationResult& result) {
  fuzz::require(!result.trajectory.frames.empty(), "a simulation has frames");
  for (const BodyPose& frame : result.trajectory.frames)
    for (const Rigid& segment : frame)
      fuzz::require(segment.translation.allFinite() && segment.rotation.coeffs().allFinite(),
                    "every frame is finite");
}

void hit(const ArticulatedBody& body, const BodyPose& segments) {
  RangeOfMotion range = human_range();
  const PerJoint<SwingTwist> charts = charts_of(range, rotations_of(segments));
  for (int j = 0; j < kJointCount; ++j) widen_to_hold(range.joints[j], charts[j], radians(3.0));
  StartState start;
  start.segments = segments;
  Scene scene;
  scene.direction = Vec3(-1.0, 0.0, 0.0);
  SimulationSettings settings;
  settings.duration_s = 10.0 / 240.0;
  Diagnostics diagnostics;
  static const ActiveThresholds thresholds = *load_active_thresholds("");
  const MuscleStrength none{};
  const auto result =
      simulate({body, range, thresholds, none, start, scene, settings, limp_behaviour(body, settings)}, diagnostics);
  if (result)
    require_finite(*result);
  else
    fuzz::require_clear(result.error());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Diagnostics diagnostics;
  const auto character = read(data, size, diagnostics);
  if (!character || character->skeleton.size() > kMostNodes) return 0;
  const auto humanoid = map_humanoid(*character, HumanoidOptions{}, diagnostics);
  if (!humanoid) {
    fuzz::require_clear(humanoid.error());
    return 0;
  }
  const Pose pose = start_pose(*character, *humanoid, StartPose::stand);
  const BodyPose segments = canonical_segments_of(character->skeleton, *humanoid, pose);
  const auto body = build_body(*character, *humanoid, pose, segments, BodyOptions{}, diagnostics);
  if (body)
    hit(*body, segments);
  else
    fuzz::require_clear(body.error());
  return 0;
}
