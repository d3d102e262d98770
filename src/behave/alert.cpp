#include "behave/alert.h"

namespace ukemi {
namespace {

constexpr double kLeastStand_s = 0.6;  // a body at the edge of its feet may be still before it acts
constexpr ToneSettings kFallingTone{0.3, 0.6};

}  // namespace

Alert::Alert(const ArticulatedBody& body, const BodyPose& home, double gravity, const StandSettings& settings)
    : standing_(body, home, gravity, settings), tone_(body, kFallingTone) {}

void Alert::start(const Senses& senses) { standing_.start(senses); }

void Alert::observe(const Senses& senses, double h) {
  time_s_ = senses.time_s;
  if (falling_) {
    Senses since = senses;
    since.time_s -= fall_s_;
    tone_.observe(since, h);
    return;
  }
  standing_.observe(senses, h);
  if (!standing_.lost_s()) return;
  falling_ = true;
  fall_s_ = senses.time_s;
  tone_.start(senses);
}

void Alert::drive(double time_s, Goals& goals) const {
  if (falling_)
    tone_.drive(time_s - fall_s_, goals);
  else
    standing_.drive(goals);
}

bool Alert::done() const { return falling_ || (time_s_ > kLeastStand_s && standing_.calm()); }

ControllerReport Alert::report() const {
  ControllerReport report;
  report.steps = standing_.steps();
  report.fall_begins_s = standing_.lost_s();
  if (standing_.lost_s()) report.events.push_back({"lost: " + standing_.lost_why(), *standing_.lost_s()});
  return report;
}

}  // namespace ukemi
