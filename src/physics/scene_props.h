// What happens to the body: a ball, a box, a ramp with a ball, a push, an impulse, a fall.
#pragma once

#include <optional>
#include <vector>

#include "base/result.h"
#include "body/trajectory.h"
#include "physics/collision.h"
#include "physics/model.h"
#include "physics/scene.h"

namespace ukemi {

/// The scene in the world. Time 0 is the first contact: whatever hits starts touching.
class SceneProps {
 public:
  SceneProps(OdeWorld& world, Model& model, Collision& collision, const Scene& scene, double gravity);

  /// Puts the props in place and gives the body what it gets at once.
  void begin(Diagnostics& diagnostics);
  /// Forces of the step that starts at `time_s`.
  void apply(double time_s) const;
  /// Work on the body in a step of length h that starts at `time_s` with the model's bodies as they were
  /// `before`, J.
  double work(double time_s, double h, const std::vector<RigidState>& before) const;
  /// Kinetic and potential energy of the props, J.
  double prop_energy() const;
  /// The soles' friction, where it is not that of everything else.
  std::optional<double> sole_friction(double time_s) const;
  bool is_blow() const { return scene_.kind != SceneKind::none; }
  double momentum_n_s() const { return momentum_; }
  /// What the body has received until `time_s`: what the missile has lost along the blow's way, N s.
  double delivered_n_s(double time_s) const;
  Vec3 impact_point() const { return impact_point_; }

  /// Props that move, in the order of `props()`.
  const std::vector<dBodyID>& bodies() const { return bodies_; }
  /// Shapes of all props, those that move first; no poses yet but the still ones'.
  const std::vector<Prop>& props() const { return props_; }

 private:
  struct Inertia {
    double mass_kg;
    Mat3 tensor;
  };
  void begin_missile(Diagnostics& diagnostics);
  void begin_slope(Diagnostics& diagnostics);
  void begin_impulse();
  void begin_fall();
  /// Where the probe's centre is when it first touches the body, and what it touches.
  struct Meeting {
    Vec3 at;
    Segment segment;
  };
  std::optional<Meeting> meet(dGeomID probe, Vec3 start) const;
  /// Where the probe's centre is when it first touches the body; aside from what is in the way, see the
  /// definition.
  Vec3 aim(dGeomID probe, Diagnostics& diagnostics) const;
  void launch(dGeomID geom, const Vec3& at, const Vec3& velocity, const Vec3& angular_velocity,
              const Quat& rotation);
  const ModelBody& body_of(Segment segment) const { return model_.bodies()[model_.body_of(segment)]; }
  const ModelBody& target() const { return model_.bodies()[model_.body_of(scene_.target)]; }
  bool pushing(double time_s) const { return is_push(scene_.kind) && time_s < scene_.push_duration_s; }

  OdeWorld& world_;
  Model& model_;
  Collision& collision_;
  Scene scene_;
  double gravity_;
  double momentum_ = 0.0;
  double carried_ = 0.0;  // by the missile at the start, along the blow's way
  Vec3 impact_point_ = Vec3::Zero();
  std::vector<dBodyID> bodies_;
  std::vector<Inertia> inertias_;
  std::vector<Prop> props_;
};

}  // namespace ukemi
