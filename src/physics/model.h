// The articulated body as ODE bodies and ball joints. Fused segments are part of the body of the segment they
// hang on.
#pragma once

#include <vector>

#include "body/body.h"
#include "physics/ode_world.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

/// Position, orientation and velocities of one rigid body.
struct RigidState {
  Vec3 position, linear_velocity, angular_velocity;
  Quat rotation;
};
RigidState read_state(dBodyID body);
void write_state(dBodyID body, const RigidState& state);
/// J; `inertia` about the centre of mass, body axes.
double kinetic_energy(double mass_kg, const Mat3& inertia, const RigidState& state);

/// A rigid body: one segment and those fused to it. Its origin is the centre of mass, its axes are the
/// segment's.
struct ModelBody {
  Segment segment = Segment::pelvis;
  dBodyID id = nullptr;
  double mass_kg = 0.0;
  Vec3 centre = Vec3::Zero();   // centre of mass in the segment's frame
  Mat3 inertia = Mat3::Zero();  // about the centre of mass, segment axes
};

struct ModelJoint {
  Joint joint = Joint::spine;
  int parent = 0, child = 0;  // bodies
  dJointID id = nullptr;
  Vec3 anchor_in_parent, anchor_in_child;            // body frames (origin: centre of mass)
  Quat parent_from_joint, joint_from_child_neutral;  // see relative()
  JointRange range;

  /// Joint rotation Q of the bodies' orientations, see JointFrame.
  Quat rotation(const Quat& world_from_parent, const Quat& world_from_child) const;
};

class Model {
 public:
  Model(OdeWorld& world, const ArticulatedBody& body, const RangeOfMotion& range);

  const std::vector<ModelBody>& bodies() const { return bodies_; }
  std::vector<ModelJoint>& joints() { return joints_; }
  const std::vector<ModelJoint>& joints() const { return joints_; }
  int body_of(Segment s) const { return host_[index(s)]; }
  /// body_from_segment: frame of a segment in its body.
  const Rigid& segment_in_body(Segment s) const { return body_from_segment_[index(s)]; }

  void place(const BodyPose& segments, const PerSegment<Vec3>& velocity,
             const PerSegment<Vec3>& angular_velocity);
  BodyPose segments() const;
  SwingTwist chart(const ModelJoint& joint) const;
  double separation(const ModelJoint& joint) const;
  /// Turns the subtree below each joint that is outside its range back to the nearest point inside, parents
  /// first.
  void project();

 private:
  void build_bodies(OdeWorld& world, const ArticulatedBody& body);
  void build_joints(OdeWorld& world, const ArticulatedBody& body, const RangeOfMotion& range);
  void turn_subtree(const ModelJoint& joint, const Quat& turn);

  PerSegment<int> host_{};
  PerSegment<Rigid> body_from_segment_;
  std::vector<ModelBody> bodies_;
  std::vector<ModelJoint> joints_;
  std::vector<std::vector<int>> below_;  // bodies of the subtree of each joint
};

}  // namespace ukemi
