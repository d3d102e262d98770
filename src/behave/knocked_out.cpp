#include "behave/knocked_out.h"

#include <algorithm>

#include "body/on_ground.h"

namespace ukemi {
namespace {

constexpr double kFades_s = 0.12;  // in which the muscles let go

}  // namespace

KnockedOut::KnockedOut(std::unique_ptr<Alert> alive, const ArticulatedBody& body, const Knockout& knockout,
                       const ToneSettings& tone)
    : alive_(std::move(alive)), knockout_(knockout), limp_(body, {tone.share, 0.0}) {}

void KnockedOut::start(const Senses& senses) {
  alive_->start(senses);
  limp_.start(senses);
  if (goes_out(senses.time_s)) out_s_ = senses.time_s;
}

bool KnockedOut::goes_out(double time_s) const {
  switch (knockout_.at) {
    case Knockout::At::time:
      return time_s >= knockout_.time_s;
    case Knockout::At::blow:
      return true;
    case Knockout::At::step:
      return alive_->has_stepped() || alive_->falls();
    case Knockout::At::landing:
      break;
  }
  return alive_->has_landed();
}

void KnockedOut::observe(const Senses& senses, double h) {
  alive_->observe(senses, h);
  if (out_s_) return limp_.observe(senses, h);
  if (goes_out(senses.time_s)) out_s_ = senses.time_s;
}

void KnockedOut::drive(double time_s, Goals& goals) const {
  const double left = out_s_ ? 1.0 - min_jerk((time_s - *out_s_) / kFades_s) : 1.0;
  if (left > 0.0) alive_->drive(time_s, goals);
  if (!out_s_) return;
  goals.help_n *= left;
  goals.firm_soles = false;
  goals.glides.fill(false);
  for (auto& joint : goals.joints)
    for (JointGoal& goal : joint) goal = weakened(goal, left);
  if (left <= 0.0) limp_.drive(time_s, goals);
}

ControllerReport KnockedOut::report() const {
  ControllerReport report = alive_->report();
  if (!out_s_) return report;
  report.knocked_out_s = out_s_;
  // What the living body did later than this does not count.
  std::erase_if(report.steps, [&](const StepTaken& step) { return step.lift_s >= *out_s_; });
  report.fall_begins_s = std::min(report.fall_begins_s.value_or(*out_s_), *out_s_);
  report.fall.settled_s.reset();
  return report;
}

}  // namespace ukemi
