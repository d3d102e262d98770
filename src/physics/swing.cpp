#include "physics/swing.h"

#include <ode/ode.h>

#include <cmath>

#include "base/errors.h"
#include "physics/model.h"
#include "physics/restriction.h"

namespace ukemi {
namespace {

constexpr double kErp = 0.8;
constexpr double kCfm = 1e-9;
constexpr Reach kReach{0.25, 0.0};
constexpr Joint kSlot = Joint::neck;  // a joint with a single segment below it

/// Two bodies: the head, its centre of mass in the joint, and everything else.
ArticulatedBody link_and_base() {
  ArticulatedBody body;
  for (BodySegment& segment : body.segments) {
    segment.mass_kg = 1.0;
    segment.inertia = 0.01 * Mat3::Identity();
  }
  for (int j = 0; j < kJointCount; ++j) body.joints[j].fused = joint_at(j) != kSlot;
  return body;
}

std::vector<SwingTwist> run(OdeWorld& world, const JointRange& range, const SwingSettings& settings) {
  dWorldSetGravity(world.id(), 0.0, 0.0, 0.0);
  dWorldSetERP(world.id(), kErp);
  dWorldSetCFM(world.id(), kCfm);
  RangeOfMotion ranges;
  ranges.joints[index(kSlot)] = range;
  Model model(world, link_and_base(), ranges);
  const ModelJoint& joint = model.joints().front();
  const ModelBody& link = model.bodies()[joint.child];
  BodyPose start;
  start[index(child_of(kSlot))].rotation =
      range.frame.relative_from_joint(joint_rotation({settings.start, 0.0}));
  PerSegment<Vec3> still;
  still.fill(Vec3::Zero());
  model.place(start, still, still);
  dBodySetKinematic(model.bodies()[joint.parent].id);

  PassiveLimit limit(world, model, joint, settings.limits);
  const double h = 1.0 / settings.rate_hz;
  const auto steps = std::lround(settings.duration_s * settings.rate_hz);
  std::vector<SwingTwist> charts = {model.chart(joint)};
  for (long step = 0; step < steps; ++step) {
    const Vec3 omega = vec3(dBodyGetAngularVel(link.id));
    const Vec3 pull = joint.parent_from_joint * swing_row(charts.back(), settings.pull);
    const Vec3 torque = link.inertia(0, 0) * (pull - settings.damping * omega);
    dBodyAddTorque(link.id, torque.x(), torque.y(), torque.z());
    limit.prepare(h, kReach, false);
    dWorldStep(world.id(), h);
    charts.push_back(model.chart(joint));
  }
  return charts;
}

}  // namespace

Result<std::vector<SwingTwist>> swing_joint(const JointRange& range, const SwingSettings& settings) {
  initialise_ode();
  OdeWorld world;
  try {
    std::vector<SwingTwist> charts = run(world, range, settings);
    for (const SwingTwist& chart : charts)
      if (!chart.swing.allFinite())
        return simulation_error("the swinging link diverged", "choose a gentler pull");
    return charts;
  } catch (const OdeFailure& failure) {
    return simulation_error(failure.what(), "choose other limits");
  }
}

}  // namespace ukemi
