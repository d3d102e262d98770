// The seat of a behaviour: what it senses after every accepted step, and what it asks of the muscles before
// each try.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "physics/goals.h"
#include "physics/senses.h"

namespace ukemi {

/// A step of the foot that a behaviour took.
struct StepTaken {
  Segment foot = Segment::foot_l;
  double lift_s = 0.0;
  std::optional<double> contact_s;  // nothing: still in the air
  double length_m = 0.0;            // of the foot's way over the ground
};

/// A moment that a report or a picture may want to show.
struct BehaviourEvent {
  std::string name;
  double time_s = 0.0;
};

/// The first time that a part of the body met the floor.
struct TouchDown {
  Segment segment = Segment::pelvis;
  double time_s = 0.0;
  double speed_m_s = 0.0;  // of the point that touched, towards the floor, just before
};

/// How a body came down; all empty before the fall.
struct FallReport {
  std::optional<double> begins_s;   // protection began
  std::optional<double> landed_s;   // the body is down
  std::optional<double> settled_s;  // and lies
  std::optional<TouchDown> first, hand, knee, pelvis, head;
  std::string end_pose;  // kneeling, seated, supine, prone, left_side, right_side
};

/// The body goes on with the motion that it had before the blow, and that motion is known.
struct GoesOn {
  double time_s = 0.0;    // since then
  double moment_s = 0.0;  // where that motion is then, s from the blow
};

/// What a behaviour did.
struct ControllerReport {
  std::vector<StepTaken> steps;
  std::optional<double> fall_begins_s;  // balance was lost
  std::optional<double> knocked_out_s;  // the body is limp from then on
  std::vector<BehaviourEvent> events;
  FallReport fall;
  std::optional<GoesOn> goes_on;  // with which the run ends
};

/// A behaviour. Its state changes in start() and observe() alone, so that a rejected step needs no undo.
class Controller {
 public:
  Controller() = default;
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;
  virtual ~Controller() = default;

  /// Before the first step, after the blow has given what it gives at once.
  virtual void start(const Senses& senses) = 0;
  /// After an accepted step of length `h` that ended in `senses`: the only place where its state changes.
  virtual void observe(const Senses& senses, double h) = 0;
  /// Before each try of a step that starts at `time_s`: adds to the goals.
  virtual void drive(double time_s, Goals& goals) const = 0;
  /// Rest ends the run only then.
  virtual bool done() const { return true; }
  /// Nothing that follows is of interest: the run ends at once.
  virtual bool hopeless() const { return false; }
  /// What follows is known: the run ends at once.
  virtual bool over() const { return false; }
  virtual ControllerReport report() const { return {}; }
};

/// Makes the behaviour of a run, anew for every try: a run that diverges is tried again with shorter steps.
/// Null: none.
using MakeController = std::function<std::unique_ptr<Controller>()>;

}  // namespace ukemi
