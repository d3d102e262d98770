#include "judge/body_course.h"

#include <algorithm>
#include <cmath>

#include "base/quantile.h"

namespace ukemi {
namespace {

constexpr double kFloorShare = 0.03;

/// Share of the body's mass, and where between two points its centre lies (de Leva 1996).
struct MassPart {
  double mass, centre;
};
constexpr MassPart kHead{.0694, .5}, kTrunk{.4346, .43};
constexpr MassPart kUpperArm{.0271, .577}, kForearm{.0162, .457}, kHand{.0061, .6};
constexpr MassPart kThigh{.1416, .41}, kShank{.0433, .446}, kFoot{.0137, .44};

struct WeightedSum {
  Vec3 moment = Vec3::Zero();
  double mass = 0.0;

  void add(const MassPart& part, const Vec3& from, const Vec3& to) {
    moment += part.mass * (from + part.centre * (to - from));
    mass += part.mass;
  }
};

Vec3 centre_of_mass(const BodyCourse& body, int f) {
  WeightedSum sum;
  sum.add(kHead, body.head[f], body.crown[f]);
  sum.add(kTrunk, body.shoulders[f], body.hips[f]);
  for (const LimbCourse& arm : body.arms) {
    sum.add(kUpperArm, arm.root[f], arm.middle[f]);
    sum.add(kForearm, arm.middle[f], arm.end[f]);
    sum.add(kHand, arm.end[f], arm.tip[f]);
  }
  for (const LimbCourse& leg : body.legs) {
    sum.add(kThigh, leg.root[f], leg.middle[f]);
    sum.add(kShank, leg.middle[f], leg.end[f]);
    sum.add(kFoot, leg.end[f], leg.tip[f]);
  }
  return sum.moment / sum.mass;
}

/// Joint `first` of a limb and the two after it, and the point that sticks out of the last.
void add_limb(const BodyPose& frame, Segment first, const Vec3& tip, double scale, LimbCourse& limb) {
  const int s = index(first);
  limb.root.push_back(scale * frame[s].translation);
  limb.middle.push_back(scale * frame[s + 1].translation);
  limb.end.push_back(scale * frame[s + 2].translation);
  limb.tip.push_back(scale * (frame[s + 2] * tip));
}

void add_frame(const JudgedMotion& motion, const BodyPose& frame, double scale, BodyCourse& body) {
  const auto at = [&](Segment s) -> Vec3 { return scale * frame[index(s)].translation; };
  body.pelvis.push_back(at(Segment::pelvis));
  body.chest.push_back(at(Segment::chest));
  body.head.push_back(at(Segment::head));
  body.crown.push_back(scale * (frame[index(Segment::head)] * motion.ends.crown));
  add_limb(frame, Segment::upperarm_l, motion.ends.knuckle[0], scale, body.arms[0]);
  add_limb(frame, Segment::upperarm_r, motion.ends.knuckle[1], scale, body.arms[1]);
  add_limb(frame, Segment::thigh_l, motion.ends.ball_of_foot[0], scale, body.legs[0]);
  add_limb(frame, Segment::thigh_r, motion.ends.ball_of_foot[1], scale, body.legs[1]);
}

double floor_height(const BodyCourse& body) {
  std::vector<double> lowest;
  for (int f = 0; f < body.frames; ++f) {
    double y = body.legs[0].end[f].y();
    for (const LimbCourse& leg : body.legs) y = std::min({y, leg.end[f].y(), leg.tip[f].y()});
    lowest.push_back(y);
  }
  return quantile(std::move(lowest), kFloorShare);
}

void lower(double by, Course& course) {
  for (Vec3& point : course) point.y() -= by;
}

void lower(double by, BodyCourse& body) {
  for (Course* course : {&body.pelvis, &body.chest, &body.head, &body.crown}) lower(by, *course);
  for (auto* limbs : {&body.arms, &body.legs})
    for (LimbCourse& limb : *limbs)
      for (Course* course : {&limb.root, &limb.middle, &limb.end, &limb.tip}) lower(by, *course);
}

/// What follows from the joints' places.
void derive(BodyCourse& body) {
  for (int f = 0; f < body.frames; ++f) {
    const Vec3 shoulder_l = body.arms[0].root[f], shoulder_r = body.arms[1].root[f];
    body.shoulders.push_back(0.5 * (shoulder_l + shoulder_r));
    body.hips.push_back(0.5 * (body.legs[0].root[f] + body.legs[1].root[f]));
    const Vec3 up = (body.shoulders[f] - body.hips[f]).normalized();
    body.up.push_back(up);
    body.front.push_back(up.cross(shoulder_r - shoulder_l).normalized());
    body.lean_deg.push_back(degrees(std::acos(std::clamp(up.y(), -1.0, 1.0))));
    body.com.push_back(centre_of_mass(body, f));
  }
}

}  // namespace

BodyCourse body_course_of(const JudgedMotion& motion) {
  BodyCourse body;
  body.fps = motion.fps;
  body.frames = static_cast<int>(motion.frames.size());
  const double scale = kJudgedHeight / motion.height_m;
  for (const BodyPose& frame : motion.frames) add_frame(motion, frame, scale, body);
  lower(floor_height(body), body);
  derive(body);
  return body;
}

double flexion_deg(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = a - b, v = c - b;
  return 180.0 - degrees(std::atan2(u.cross(v).norm(), u.dot(v)));
}

double flexion_deg(const LimbCourse& limb, int frame) {
  return flexion_deg(limb.root[frame], limb.middle[frame], limb.end[frame]);
}

double hand_height(const LimbCourse& arm, int frame) {
  return std::min(arm.end[frame].y(), arm.tip[frame].y());
}

}  // namespace ukemi
