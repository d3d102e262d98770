// A hand on a wrist whose other side does not move: everything else is one body of 1e9 times its mass.
#pragma once

#include <ode/ode.h>

#include <functional>
#include <optional>

#include "physics/model.h"
#include "simulate/standing_man.h"

namespace ukemi::test {

class HandOnWrist {
 public:
  /// Turning at `spin`, rad/s; `change` may give the hand another mass.
  explicit HandOnWrist(const Vec3& spin, const std::function<void(BodySegment&)>& change = {}) {
    StandingMan man;
    for (BodyJoint& joint : man.body.joints) joint.fused = true;
    man.body.joints[index(Joint::wrist_r)].fused = false;
    for (int s = 0; s < kSegmentCount; ++s) {
      if (segment_at(s) == Segment::hand_r) continue;
      man.body.segments[s].mass_kg *= 1e9;
      man.body.segments[s].inertia *= 1e9;
    }
    if (change) change(man.body.segments[index(Segment::hand_r)]);
    dWorldSetCFM(world_.id(), 1e-9);
    model_.emplace(world_, man.body, man.range);
    PerSegment<Vec3> still;
    still.fill(Vec3::Zero());
    PerSegment<Vec3> turning = still;
    turning[index(Segment::hand_r)] = spin;
    model_->place(man.segments, still, turning);
  }

  OdeWorld& world() { return world_; }
  const Model& model() const { return *model_; }
  const ModelJoint& wrist() const { return model_->joints()[0]; }
  const ModelBody& hand() const { return model_->bodies()[model_->body_of(Segment::hand_r)]; }

 private:
  OdeWorld world_;
  std::optional<Model> model_;
};

}  // namespace ukemi::test
