#include "behave/fall_posture.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "body/on_ground.h"

namespace ukemi {
namespace {

constexpr double kSpineShare = 0.54;     // of the trunk's bend; the chest has the rest
constexpr double kSpineTurnShare = 0.3;  // of its turn
constexpr double kFullBendBeyond_m =
    0.25;  // the legs bend fully when the centre of mass is this far outside the soles
constexpr double kLeastBend = 0.3;

/// A value for each way of falling, mixed by the weights; degrees in, radians out.
struct ByWay {
  double forward, backward, sideways;
  double of(const FallWay& way) const {
    return radians(forward * way.forward + backward * way.backward + sideways * way.sideways);
  }
};

constexpr ByWay kNeck{45.0, 46.0, 30.0};   // away from the ground
constexpr ByWay kTrunk{-12.0, 42.0, 8.0};  // flexion
constexpr ByWay kTrunkAside{0.0, 0.0, 16.0};
constexpr ByWay kTrunkTurn{0.0, 0.0, 26.0};
constexpr ByWay kHip{50.0, 70.0, 55.0};
constexpr ByWay kKnee{95.0, 110.0, 98.0};
constexpr ByWay kAnkle{-5.0, 12.0, 0.0};
constexpr ByWay kClavicle{12.0, -8.0, 6.0};  // protraction
constexpr double kAbduction = radians(5.0);
// A dive: the trunk is level (degrees from upright) while the knees are up: then nothing but the belly comes
// down.
constexpr double kDivesFrom = 50.0, kDivesIn = 30.0;
constexpr double kKneeling_m = 0.15, kKneesUp_m = 0.2;  // knees this low kneel, this much higher do not
constexpr double kDivingKnees = 0.75;                   // share of their bend that goes
constexpr double kSidewaysLegs = 0.25;                  // the lower leg bends more by this share

Quat bend(double about_x, double about_y, double about_z) {
  return exp_rotation(Vec3(about_x, about_y, about_z));
}

void bend_trunk(const FallWay& way, const FallVariation& variation, PerJoint<Quat>& goals) {
  const double flexion = kTrunk.of(way);
  const double aside = -way.side * kTrunkAside.of(way);
  const double turn = -way.side * kTrunkTurn.of(way) + variation.trunk_turn;
  goals[index(Joint::spine)] = bend(kSpineShare * aside, kSpineTurnShare * turn, -kSpineShare * flexion);
  goals[index(Joint::chest)] =
      bend((1.0 - kSpineShare) * aside, (1.0 - kSpineTurnShare) * turn, -(1.0 - kSpineShare) * flexion);
  // y x (-A d): chin in backward, up forward, ear up sideways.
  const double away = kNeck.of(way);
  goals[index(Joint::neck)] = bend(-away * way.side_down.y(), variation.head_turn, away * way.side_down.x());
}

void bend_leg(const FallWay& way, double bending, double flat, BodySide side, PerJoint<Quat>& goals) {
  goals[index(on(side, Joint::hip_r))] =
      bend(-sign(side) * kAbduction * bending, 0.0, kHip.of(way) * bending * (1.0 - flat));
  goals[index(on(side, Joint::knee_r))] =
      bend(0.0, 0.0, -kKnee.of(way) * bending * (1.0 - kDivingKnees * flat));
  goals[index(on(side, Joint::ankle_r))] = bend(0.0, 0.0, kAnkle.of(way) * bending);
}

}  // namespace

FallVariation fall_variation(std::uint64_t seed) {
  Random random(seed);
  const auto either = [&random](double low, double high) {
    const double size = random.uniform(low, high);
    return random.uniform(-1.0, 1.0) < 0.0 ? -size : size;
  };
  FallVariation v;
  v.leg_bend = either(0.08, 0.18);
  v.trunk_turn = either(radians(2.0), radians(8.0));
  v.head_turn = either(radians(4.0), radians(15.0));
  v.arm_delay_s = either(0.02, 0.07);
  for (Vec2& hand : v.hand_m) hand = Vec2(random.uniform(-0.05, 0.05), random.uniform(-0.03, 0.05));
  const double stretch = either(0.02, 0.05);
  v.stretch = {0.90 - stretch, 0.90 + stretch};
  v.lying_side = either(1.0, 1.0);
  return v;
}

double dive(const FallBody& body, const Senses& senses, const FallWay& way) {
  const double up = (senses.pose[index(Segment::chest)].rotation * Vec3::UnitY()).y();
  const double pitch = degrees(std::acos(std::clamp(up, -1.0, 1.0)));
  const double knees_m = std::min(senses.pose[index(Segment::shank_l)].translation.y(),
                                  senses.pose[index(Segment::shank_r)].translation.y());
  return way.forward * min_jerk((pitch - kDivesFrom) / kDivesIn) *
         min_jerk((knees_m / body.lambda - kKneeling_m) / kKneesUp_m);
}

void crouch(const FallWay& way, const FallVariation& variation, double lambda, double flat,
            PerJoint<Quat>& goals) {
  bend_trunk(way, variation, goals);
  const double far = kLeastBend + (1.0 - kLeastBend) * min_jerk(way.beyond_m / (kFullBendBeyond_m * lambda));
  for (const BodySide side : kSides) {
    const double lower = kSidewaysLegs * way.sideways * (sign(side) == way.side ? 1.0 : -1.0);
    const double own = variation.leg_bend * sign(side) * (1.0 - way.sideways);
    bend_leg(way, far * (1.0 + own + lower), flat, side, goals);
    goals[index(on(side, Joint::clavicle_r))] = bend(0.0, sign(side) * kClavicle.of(way), 0.0);
  }
}

}  // namespace ukemi
