// The seat of a behaviour: what it senses after every accepted step, and what it asks of the muscles.
//
// Frames: segment frames are anatomical (x to the front, y up along the segment in the neutral pose, z to the body's
// right). World: y up, the floor at y = 0. SI units, radians.
#pragma once

#include <optional>
#include <vector>

#include "base/math.h"
#include "base/segments.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

/// One point where a segment touches something.
struct SegmentContact {
  enum class With { floor, prop, self };
  Segment segment = Segment::pelvis;
  With with = With::floor;
  Vec3 place = Vec3::Zero();   // world, m
  Vec3 normal = Vec3::Zero();  // unit, from what is touched into the segment
  double depth_m = 0.0;
};

/// The body at the end of an accepted step (or at the start). No engine type, nothing stored from one step to the next.
struct Senses {
  double time_s = 0.0;
  BodyPose pose;                         // world_from_segment
  PerSegment<Vec3> centre;               // of mass, world, m
  PerSegment<Vec3> velocity;             // of the centre of mass, m/s
  PerSegment<Vec3> angular_velocity;     // world, rad/s
  PerJoint<SwingTwist> chart;            // identity at fused joints
  Vec3 com = Vec3::Zero();               // of the body
  Vec3 com_velocity = Vec3::Zero();      // m/s
  Vec3 angular_momentum = Vec3::Zero();  // about the centre of mass, kg m^2/s
  double fastest_m_s = 0.0;              // largest speed of a rigid body's centre
  double fastest_turning_rad_s = 0.0;
  std::vector<SegmentContact> contacts;
};

/// A spring, a damper and a torque at one joint, taken implicitly:
///   torque on the child = feed_forward - stiffness * error - damping * (omega - velocity), the opposite on the parent;
/// error: rotation vector from the goal to the present rotation; omega: of the child relative to the parent.
struct JointGoal {
  Quat parent_from_child = Quat::Identity();  // goal, between segment frames
  Vec3 velocity = Vec3::Zero();               // wanted omega, world, rad/s
  Vec3 feed_forward_n_m = Vec3::Zero();       // world
  double stiffness_n_m_rad = 0.0;
  double damping_n_m_s_rad = 0.0;
  /// Torque about the parent segment's x (abduction), y (turning) and z (flexion): least and most, N m.
  Vec3 least_n_m = Vec3::Zero(), most_n_m = Vec3::Zero();
};

/// Tone: a spring towards a pose that gives way: what it asks for stays below a cap by growing softer, so that it
/// never hits its cap hard.
struct SoftGoal {
  Quat parent_from_child = Quat::Identity();
  double cap_n_m = 0.0;  // given at an error of 0.35 rad; damping is 0.12 s times the stiffness
};

/// What is asked of every joint. Goals of several controllers add up; the sum is capped by what the joint can give.
struct Goals {
  PerJoint<std::vector<JointGoal>> joints;
  PerJoint<std::optional<SoftGoal>> tone;
  /// Soles do not slip while the body balances on them (friction of the soles without a bound).
  bool firm_soles = false;
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
};

}  // namespace ukemi
