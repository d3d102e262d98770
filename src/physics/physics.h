// The body, its restriction and muscles, the floor and the scene in one ODE world: states, steps, figures of
// the present.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "body/body.h"
#include "body/muscles.h"
#include "body/trajectory.h"
#include "physics/collision.h"
#include "physics/goals.h"
#include "physics/model.h"
#include "physics/muscles.h"
#include "physics/restriction.h"
#include "physics/scene.h"
#include "physics/scene_props.h"
#include "physics/senses.h"
#include "restrict/active.h"

namespace ukemi {

struct PhysicsSettings {
  Limits limits = Limits::edges;
  Active active = Active::implicit;
  double active_k = 15.0;       // 1/s
  double active_delay_s = 0.0;  // reaction time of the active restriction
  double damping = 0.0;         // joint damping, 1/s
  double gravity = 9.81;        // m/s^2, downwards
  bool self_collision = true;
  bool adaptive = true;               // steps may be taken again with rows that were missing
  Reach reach{0.02, 1.5};             // of the rows
  double max_correcting_speed = 0.3;  // m/s, of contacts
  bool sparse_friction = true;
};

/// Thrown where the state is no longer plausible: not finite, too fast, torn apart.
struct Diverged {
  Segment segment;
  double time_s, speed;
  std::string how{};  // where it is not the speed
};

class Physics {
 public:
  Physics(const ArticulatedBody& body, const RangeOfMotion& range, const ActiveThresholds& thresholds,
          const MuscleStrength& strength, const StartState& start, const Scene& scene,
          const PhysicsSettings& settings);

  /// Puts the props in place and gives the body what it gets at once.
  void begin(Diagnostics& diagnostics);
  /// Tries a step of length h from `time_s`, once more with all rows of a joint that went beyond an edge
  /// which had none. Throws Diverged, OdeFailure.
  void step(double time_s, double h, const Goals& goals, const Contacts& contacts);
  /// Keeps the present state; restore() goes back to it.
  void save();
  void restore();
  /// The step of length h that has just been taken counts. Work of the scene and the muscles in it, J.
  double accept(double time_s, double h);

  /// Throws Diverged.
  void check_speeds(double time_s) const;
  /// The segment that was fastest when the state was saved.
  Diverged fastest(double time_s, std::string how) const;

  Contacts find_contacts() const { return collision_.find(firm_soles_); }
  /// See Collision::forget_overlaps.
  void forget_overlaps(const Contacts& present) { collision_.forget_overlaps(present); }
  bool is_floor(std::size_t pair) const { return collision_.is_floor(pair); }
  std::vector<double> joint_excesses() const;
  double worst_separation() const;
  /// The body whose joint has come apart farthest, for an error.
  Diverged farthest_apart(double time_s, double separation) const;
  double worst_joint_speed() const;
  /// See Model::project.
  void project() { model_.project(); }

  const Model& model() const { return model_; }
  BodyPose segments() const { return model_.segments(); }
  Senses senses(double time_s, const Contacts& contacts) const;
  std::vector<Rigid> prop_poses() const;
  const SceneProps& scene() const { return scene_; }
  /// Largest share of its strength that any joint's muscle gave in the last accepted step.
  double muscle_share() const { return muscle_share_; }
  double muscle_work_j() const { return muscle_work_; }
  /// Given from outside so far, see Goals::help_n: sum of amounts.
  double help_n_s() const { return help_n_s_; }

 private:
  void set_erp(double h);
  void add_forces(double time_s, double h, const Goals& goals);
  void make_motors(const Goals& goals);

  PhysicsSettings settings_;
  MuscleStrength strength_;
  std::vector<BodySegment> parts_;  // of the segments, for the senses
  OdeWorld world_;
  Model model_;
  Collision collision_;
  SceneProps scene_;
  std::vector<PassiveLimit> passive_;
  std::vector<ActiveLimit> active_;
  std::vector<Tone> tone_;
  std::vector<Muscle> muscles_;
  std::vector<bool> all_rows_;
  std::vector<RigidState> saved_;
  double erp_h_ = 0.0;
  bool firm_soles_ = false;     // asked for in the last step
  Vec3 help_n_ = Vec3::Zero();  // asked for in the last step
  double muscle_share_ = 0.0, muscle_work_ = 0.0, help_n_s_ = 0.0;
};

}  // namespace ukemi
