#include "behave/fall_landing.h"

#include <cmath>

#include "body/on_ground.h"

namespace ukemi {
namespace {

constexpr double kBrakedAfter_s = 0.06;
constexpr double kBrakedSink_m_s = 0.15;  // of the shoulder
constexpr double kSlowPelvis_m_s = 0.5;
constexpr double kFullBrake_s = 0.05;  // after the touch
constexpr double kLetsSink_m_s = 0.4,
                 kHardBraking_m_s = 0.6;  // of the shoulder: no more brake; so much more: all
constexpr double kBrakeFilter_s = 0.06;
constexpr double kForwardFall = 0.3;  // the front goes down by more than this: thighs that touch are knees

}  // namespace

void Landing::observe_arm(const FallBody& body, const Senses& senses, BodySide side, double h) {
  ArmLanding& arm = arms_[index(side)];
  const Segment hand = on(side, Segment::hand_r);
  const double sink = -senses.velocity[index(on(side, Segment::upperarm_r))].y();
  if (!arm.touched_s) {
    if (!on_floor(senses, hand) && !on_floor(senses, on(side, Segment::forearm_r))) return;
    arm.touched_s = senses.time_s;
    arm.wrist = senses.pose[index(hand)].translation;
    arm.sink_m_s = sink;
  }
  if (senses.time_s - *arm.touched_s > kFullBrake_s * body.tau) {
    const double wanted = min_jerk((sink / body.tau - kLetsSink_m_s) / kHardBraking_m_s);
    arm.brake += (wanted - arm.brake) * (1.0 - std::exp(-h / (kBrakeFilter_s * body.tau)));
  }
  const bool while_s = senses.time_s - *arm.touched_s >= kBrakedAfter_s * body.tau;
  if (!arm.braked_s && while_s && sink < kBrakedSink_m_s * body.tau) arm.braked_s = senses.time_s;
}

bool Landing::is_down(const FallBody& body, const Senses& senses, const FallWay& way) const {
  for (const Segment s :
       {Segment::pelvis, Segment::abdomen, Segment::chest, Segment::upperarm_l, Segment::upperarm_r})
    if (on_floor(senses, s)) return true;
  const bool hand = arms_[0].touched_s || arms_[1].touched_s;
  const bool thigh = on_floor(senses, Segment::thigh_l) || on_floor(senses, Segment::thigh_r);
  if (thigh && (hand || way.side_down.x() <= kForwardFall)) return true;
  return arms_[0].braked_s && arms_[1].braked_s &&
         senses.velocity[index(Segment::pelvis)].norm() < kSlowPelvis_m_s * body.tau;
}

void Landing::observe(const FallBody& body, const Senses& senses, const FallWay& way, double h) {
  for (const BodySide side : kSides) observe_arm(body, senses, side, h);
  const bool legs = on_floor(senses, Segment::shank_l) || on_floor(senses, Segment::shank_r) ||
                    on_floor(senses, Segment::thigh_l) || on_floor(senses, Segment::thigh_r);
  if (!kneels_s_ && legs && way.side_down.x() > kForwardFall) kneels_s_ = senses.time_s;
  if (!landed_s_ && is_down(body, senses, way)) landed_s_ = senses.time_s;
  const bool trunk = on_floor(senses, Segment::pelvis) || on_floor(senses, Segment::abdomen) ||
                     on_floor(senses, Segment::chest);
  if (!trunk_down_s_ && trunk) trunk_down_s_ = senses.time_s;
  if (!chest_down_s_ && on_floor(senses, Segment::chest)) chest_down_s_ = senses.time_s;
}

}  // namespace ukemi
