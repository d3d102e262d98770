// What behaviours ask of a joint, as motors: muscles with a true cap, and tone that grows softer.
#pragma once

#include <optional>
#include <vector>

#include "body/muscles.h"
#include "physics/goals.h"
#include "physics/motor.h"

namespace ukemi {

/// Muscle tone of one joint: the spring and damper of a SoftGoal, implicit. Beyond Era et al.: a person
/// who is hit stiffens first, then gives way.
class Tone {
 public:
  Tone(OdeWorld& world, const Model& model, const ModelJoint& joint);

  void prepare(double h, const std::optional<SoftGoal>& goal);
  /// What the muscles did in the step of length h that has just been taken, J; less than 0 where they gave
  /// way.
  double work(double h) const;

 private:
  const Model& model_;
  const ModelJoint& joint_;
  dJointID motor_;
  struct Row {
    Vec3 axis;
    double target, cfm;  // torque = (target - speed after the step) / cfm
    double speed;        // before the step, rad/s
  };
  std::vector<Row> rows_;
};

/// The muscles of one joint: the sum of all goals as one implicit row per axis of the parent segment. The
/// torque of the sum stays within the joint's strength, within the sum of what the goals allow, and grows by
/// no more than the strength in kRise_s.
class Muscle {
 public:
  Muscle(OdeWorld& world, const Model& model, const ModelJoint& joint, const JointStrength& strength);

  /// Begins a step, which may be tried several times.
  void begin_step() { careful_ = wary_steps_ > 0, missed_ = false; }
  /// Every row has its bounds in the tries of this step that follow.
  void take_care() { careful_ = true; }
  /// Rows that are expected to stay well within their bounds have none, which costs the engine far less and
  /// gives the same torque. Where the expectation was wrong, read() says so, and the next try is careful, as
  /// are some steps to come.
  void prepare(double h, const std::vector<JointGoal>& goals);
  /// What was given in the step that has just been taken, N m, parent axes of its beginning.
  const Vec3& torque() const { return torque_; }
  /// Reads the torques of the try that has just been made. False: it must be made again.
  bool read();
  /// The step counts: its torques are what the next ones grow from.
  void accept();
  double work(double h) const;
  /// Largest share of the strength that `torque()` uses.
  double share() const;

 private:
  struct Sum {
    Vec3 wanted = Vec3::Zero();  // torque at rest, parent axes
    double damping = 0.0;        // N m s, with h times the stiffness
    Vec3 least = Vec3::Zero(), most = Vec3::Zero();
  };
  Sum sum_of(double h, const std::vector<JointGoal>& goals, const Mat3& axes) const;
  /// `omega`: parent axes.
  void bound(double h, const Vec3& omega, Sum& sum) const;

  const Model& model_;
  const ModelJoint& joint_;
  JointStrength strength_;
  dJointID motor_;
  struct Row {
    MotorRow motor;
    double centre = 0.0;    // torque that is added outright; the motor gives the rest
    double most_n_m = 0.0;  // of the motor, whether the engine is told or not
    double speed = 0.0;     // before the step, rad/s
  };
  std::vector<Row> rows_;
  Vec3 torque_ = Vec3::Zero();
  bool careful_ = false, missed_ = false;  // in this step
  int wary_steps_ = 0;                     // left to be careful in
  std::optional<Vec3>
      given_;  // in the last step that counts; nothing before the first, which may ask for anything
};

}  // namespace ukemi
