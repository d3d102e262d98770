// Getting up from the floor, planned: key poses of a route, made to fit the body and the places it touches,
// and the motion between them with hands, knees and feet kept where they bear.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "body/body.h"
#include "humanoid/humanoid.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

enum class GetUpStyle { plain, quick, heavy, hurt };

struct GetUpSettings {
  GetUpStyle style = GetUpStyle::plain;
  std::uint64_t seed = 0;  // chooses side and route where both are open, varies times and postures
  double fps = 60.0;
};

/// A moment of the get-up, seconds after its first frame.
struct GetUpPhase {
  std::string name;  // "turns", "sits", "pushes", "on_all_fours", "half_kneels", "squats", "rises", "stands"
  double time_s = 0.0;
};

/// A part that bears and stays: frames [first, last].
struct PlantedPart {
  Segment segment = Segment::foot_l;
  Vec3 point = Vec3::Zero();  // segment frame
  Vec3 place = Vec3::Zero();  // world
  int first = 0, last = 0;
};

struct GetUp {
  double fps = 60.0;
  std::vector<BodyPose> frames;  // the first is the lying pose, the last the standing pose at the new place
  std::vector<GetUpPhase> phases;
  std::vector<PlantedPart> planted;
  std::string route;  // "sits", "side", "prone", "seated", "kneeling"
};

/// How the body lies: decides the route.
enum class Lying { supine, prone, left_side, right_side, seated, kneeling, upright };
std::string_view name(Lying lying);
Lying lying_of(const ArticulatedBody& body, const BodyPose& pose);

/// `before` is the pose one frame before `lying` (its velocity is carried on); `standing` any place and
/// heading: it is moved over the ground to where he stands up. `outermost_skin`: body/ground.h. The floor is
/// y = 0. Errors: usage (he does not lie, sit or kneel).
Result<GetUp> plan_get_up(const ArticulatedBody& body, const RangeOfMotion& range, const BodyPose& before,
                          const BodyPose& lying, const BodyPose& standing,
                          const PerSegment<std::vector<Vec3>>& outermost_skin, const GetUpSettings& settings);

}  // namespace ukemi
