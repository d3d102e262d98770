#include "behave/alert.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace ukemi {
namespace {

constexpr double kLeastStand_s = 0.6;     // a body at the edge of its feet may be still before it acts
constexpr double kHandOver_s = 0.05;      // from the loss of balance to the first protecting motion
constexpr double kLongestSwing_s = 0.45;  // longest time in the air of a foot once balance is lost

bool is_foot(Segment s) { return s == Segment::foot_l || s == Segment::foot_r; }

bool beyond_feet(const Senses& senses) {
  return std::any_of(senses.contacts.begin(), senses.contacts.end(), [](const SegmentContact& c) {
    return c.with == SegmentContact::With::floor && !is_foot(c.segment);
  });
}

}  // namespace

JointGoal weakened(JointGoal goal, double share) {
  goal.feed_forward_n_m *= share;
  goal.stiffness_n_m_rad *= share;
  goal.damping_n_m_s_rad *= share;
  goal.least_n_m *= share;
  goal.most_n_m *= share;
  return goal;
}

Alert::Alert(std::unique_ptr<OnFeet> on_feet, const ArticulatedBody& body, const RangeOfMotion& range,
             const MuscleStrength& strength, const FallSettings& falling, bool must_stand)
    : on_feet_(std::move(on_feet)),
      falling_(falling, body, range, strength),
      tempo_(on_feet_->physique().tempo),
      must_stand_(must_stand) {}

void Alert::start(const Senses& senses) {
  on_feet_->start(senses);
  falling_.start(senses);
}

void Alert::observe(const Senses& senses, double h) {
  time_s_ = senses.time_s;
  if (!over_) on_feet_->observe(senses, h);
  if (falling_.begun()) {
    release_swinging_leg(senses);
    falling_.observe(senses, h);
    over_ = over_ || standing_over(time_s_);
    return;
  }
  falling_.watch(senses, h);
  if (on_feet_->lost_s() && time_s_ >= *on_feet_->lost_s() + kHandOver_s * tempo_) begin_fall(senses);
}

/// A leg in the air goes on as it was until its foot is down.
void Alert::begin_fall(const Senses& senses) {
  PerJoint<double> from_s;
  from_s.fill(senses.time_s);
  swinging_ = on_feet_->swinging();
  if (swinging_)
    for (const Joint joint : {Joint::hip_r, Joint::knee_r, Joint::ankle_r})
      from_s[index(on(*swinging_, joint))] = std::numeric_limits<double>::infinity();
  falling_.begin(senses, from_s);
}

void Alert::release_swinging_leg(const Senses& senses) {
  if (!swinging_) return;
  const bool down = on_feet_->swinging() != swinging_ || beyond_feet(senses);
  if (!down && senses.time_s < *on_feet_->lost_s() + kLongestSwing_s * tempo_) return;
  for (const Joint joint : {Joint::hip_r, Joint::knee_r, Joint::ankle_r})
    falling_.fade_in(on(*swinging_, joint), senses.time_s);
  swinging_.reset();
}

bool Alert::has_stepped() const {
  const std::vector<StepTaken>& steps = on_feet_->steps();
  return std::any_of(steps.begin(), steps.end(),
                     [](const StepTaken& step) { return step.contact_s.has_value(); });
}

bool Alert::standing_over(double time_s) const {
  for (int j = 0; j < kJointCount; ++j)
    if (falling_.faded(joint_at(j), time_s) < 1.0) return false;
  return true;
}

void Alert::drive(double time_s, Goals& goals) const {
  if (!over_) {
    Goals standing;
    on_feet_->drive(standing);
    for (int j = 0; j < kJointCount; ++j) {
      const double share = 1.0 - falling_.faded(joint_at(j), time_s);
      for (const JointGoal& goal : standing.joints[j])
        if (share > 0.0) goals.joints[j].push_back(weakened(goal, share));
    }
    if (!falling_.begun()) {
      goals.firm_soles = standing.firm_soles;
      goals.glides = standing.glides;
      goals.help_n += standing.help_n;
    }
  }
  falling_.drive(time_s, goals);
}

bool Alert::done() const {
  if (falling_.begun()) return falling_.done();
  return !on_feet_->lost_s() && time_s_ > kLeastStand_s && on_feet_->calm();
}

ControllerReport Alert::report() const {
  ControllerReport report = falling_.report();
  report.steps = on_feet_->steps();
  report.fall_begins_s = on_feet_->lost_s();
  report.goes_on = on_feet_->goes_on();
  if (on_feet_->lost_s())
    report.events.insert(report.events.begin(), {"lost: " + on_feet_->lost_why(), *on_feet_->lost_s()});
  return report;
}

}  // namespace ukemi
