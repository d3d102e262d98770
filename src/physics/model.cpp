#include "physics/model.h"

#include <ode/ode.h>

namespace ukemi {

RigidState read_state(dBodyID body) {
  return {vec3(dBodyGetPosition(body)), vec3(dBodyGetLinearVel(body)), vec3(dBodyGetAngularVel(body)),
          quat(dBodyGetQuaternion(body))};
}

void write_state(dBodyID body, const RigidState& state) {
  dBodySetPosition(body, state.position.x(), state.position.y(), state.position.z());
  set_quaternion(body, state.rotation);
  dBodySetLinearVel(body, state.linear_velocity.x(), state.linear_velocity.y(), state.linear_velocity.z());
  dBodySetAngularVel(body, state.angular_velocity.x(), state.angular_velocity.y(),
                     state.angular_velocity.z());
}

double kinetic_energy(double mass_kg, const Mat3& inertia, const RigidState& state) {
  const Vec3 omega = state.rotation.conjugate() * state.angular_velocity;
  return 0.5 * mass_kg * state.linear_velocity.squaredNorm() + 0.5 * omega.dot(inertia * omega);
}

Quat ModelJoint::rotation(const Quat& world_from_parent, const Quat& world_from_child) const {
  return (parent_from_joint.conjugate() * world_from_parent.conjugate() * world_from_child *
          joint_from_child_neutral)
      .normalized();
}

Model::Model(OdeWorld& world, const ArticulatedBody& body, const RangeOfMotion& range) {
  build_bodies(world, body);
  build_joints(world, body, range);
}

void Model::build_bodies(OdeWorld& world, const ArticulatedBody& body) {
  PerSegment<Rigid> host_from_segment;  // frame of the host's own segment
  for (int s = 0; s < kSegmentCount; ++s) {
    const bool fused = s > 0 && body.joints[s - 1].fused;
    if (!fused) {
      host_[s] = static_cast<int>(bodies_.size());
      bodies_.push_back({segment_at(s), nullptr, 0.0, Vec3::Zero(), Mat3::Zero()});
      continue;
    }
    const int parent = index(parent_of(segment_at(s)));
    host_[s] = host_[parent];
    host_from_segment[s] = host_from_segment[parent] * body.joints[s - 1].parent_from_child;
  }
  for (int s = 0; s < kSegmentCount; ++s) {
    ModelBody& host = bodies_[host_[s]];
    host.mass_kg += body.segments[s].mass_kg;
    host.centre += body.segments[s].mass_kg * (host_from_segment[s] * body.segments[s].centre_of_mass);
  }
  for (ModelBody& host : bodies_) host.centre /= host.mass_kg;
  for (int s = 0; s < kSegmentCount; ++s) {
    ModelBody& host = bodies_[host_[s]];
    const BodySegment& part = body.segments[s];
    const Mat3 r = host_from_segment[s].rotation.toRotationMatrix();
    const Vec3 d = host_from_segment[s] * part.centre_of_mass - host.centre;
    host.inertia += r * part.inertia * r.transpose() +
                    part.mass_kg * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
    body_from_segment_[s] = {host_from_segment[s].rotation, host_from_segment[s].translation - host.centre};
  }
  for (ModelBody& host : bodies_) {
    host.id = dBodyCreate(world.id());
    dMass mass;
    const Mat3& i = host.inertia;
    dMassSetParameters(&mass, host.mass_kg, 0, 0, 0, i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2));
    dBodySetMass(host.id, &mass);
    dBodySetGyroscopicMode(host.id, 1);
    dBodySetFiniteRotationMode(host.id, 1);
  }
}

void Model::build_joints(OdeWorld& world, const ArticulatedBody& body, const RangeOfMotion& range) {
  for (int j = 0; j < kJointCount; ++j) {
    if (body.joints[j].fused) continue;
    const Joint joint = joint_at(j);
    ModelJoint made;
    made.joint = joint;
    made.parent = body_of(parent_of(joint));
    made.child = body_of(child_of(joint));
    made.range = range.joints[j];
    const JointFrame& frame = made.range.frame;
    const Rigid& parent = segment_in_body(parent_of(joint));
    made.parent_from_joint = parent.rotation * frame.parent_from_joint;
    made.joint_from_child_neutral = frame.reference.conjugate() * frame.parent_from_joint;
    made.anchor_in_parent = parent * body.joints[j].anchor_in_parent;
    made.anchor_in_child = segment_in_body(child_of(joint)).translation;
    made.id = dJointCreateBall(world.id(), nullptr);
    joints_.push_back(std::move(made));
  }
  below_.resize(joints_.size());
  for (std::size_t j = 0; j < joints_.size(); ++j)
    for (int b = 0; b < static_cast<int>(bodies_.size()); ++b)
      for (Segment s = bodies_[b].segment;; s = parent_of(s)) {
        if (body_of(s) == joints_[j].child) {
          below_[j].push_back(b);
          break;
        }
        if (s == Segment::pelvis) break;
      }
}

void Model::place(const BodyPose& segments, const PerSegment<Vec3>& velocity,
                  const PerSegment<Vec3>& angular_velocity) {
  for (const ModelBody& body : bodies_) {
    const int s = index(body.segment);
    const Vec3 offset = segments[s].rotation * body.centre;
    write_state(body.id, {segments[s].translation + offset, velocity[s] + angular_velocity[s].cross(offset),
                          angular_velocity[s], segments[s].rotation.normalized()});
  }
  for (ModelJoint& joint : joints_) {
    const RigidState child = read_state(bodies_[joint.child].id);
    const Vec3 anchor = child.position + child.rotation * joint.anchor_in_child;
    dJointAttach(joint.id, bodies_[joint.parent].id, bodies_[joint.child].id);
    dJointSetBallAnchor(joint.id, anchor.x(), anchor.y(), anchor.z());
  }
}

BodyPose Model::segments() const {
  std::vector<Rigid> bodies;
  bodies.reserve(bodies_.size());
  for (const ModelBody& body : bodies_)
    bodies.push_back({quat(dBodyGetQuaternion(body.id)), vec3(dBodyGetPosition(body.id))});
  BodyPose pose;
  for (int s = 0; s < kSegmentCount; ++s) pose[s] = bodies[host_[s]] * body_from_segment_[s];
  return pose;
}

SwingTwist Model::chart(const ModelJoint& joint) const {
  return swing_twist(joint.rotation(quat(dBodyGetQuaternion(bodies_[joint.parent].id)),
                                    quat(dBodyGetQuaternion(bodies_[joint.child].id))));
}

double Model::separation(const ModelJoint& joint) const {
  const RigidState parent = read_state(bodies_[joint.parent].id);
  const RigidState child = read_state(bodies_[joint.child].id);
  return (parent.position + parent.rotation * joint.anchor_in_parent - child.position -
          child.rotation * joint.anchor_in_child)
      .norm();
}

void Model::turn_subtree(const ModelJoint& joint, const Quat& turn) {
  const RigidState child = read_state(bodies_[joint.child].id);
  const Vec3 anchor = child.position + child.rotation * joint.anchor_in_child;
  for (const int b : below_[static_cast<std::size_t>(&joint - joints_.data())]) {
    const dBodyID id = bodies_[b].id;
    const Vec3 position = anchor + turn * (vec3(dBodyGetPosition(id)) - anchor);
    dBodySetPosition(id, position.x(), position.y(), position.z());
    set_quaternion(id, (turn * quat(dBodyGetQuaternion(id))).normalized());
  }
}

void Model::project() {
  for (const ModelJoint& joint : joints_) {
    const SwingTwist before = chart(joint);
    if (excess(joint.range, before) <= 0.0) continue;
    // world_from_child is to become world_from_parent * parent_from_joint * Q' *
    // (joint_from_child_neutral)^-1.
    const Quat parent = quat(dBodyGetQuaternion(bodies_[joint.parent].id));
    const Quat child = quat(dBodyGetQuaternion(bodies_[joint.child].id));
    const Quat wanted = parent * joint.parent_from_joint *
                        joint_rotation(clamp_to_range(joint.range, before)) *
                        joint.joint_from_child_neutral.conjugate();
    turn_subtree(joint, (wanted * child.conjugate()).normalized());
  }
}

}  // namespace ukemi
