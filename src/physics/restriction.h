// Joint restrictions as ODE motors: passive (edges, segments, axis) and active.
#pragma once

#include <vector>

#include "physics/model.h"
#include "restrict/active.h"
#include "restrict/limit_rows.h"

namespace ukemi {

enum class Limits { edges, segments, segments_euler, axis, none };
enum class Active { implicit, explicit_torque, off };

/// Which rows are present in a step.
struct Reach {
  double margin = 0.02;  // rad: rows this near always
  double steps = 1.5;    // and those that the present speed reaches within this many steps
};

/// The passive restriction of one joint. Sets its motors before each step.
class PassiveLimit {
 public:
  PassiveLimit(OdeWorld& world, const Model& model, const ModelJoint& joint, Limits kind);

  /// `all`: every row, whatever its distance.
  void prepare(double h, const Reach& reach, bool all);
  /// Largest angle, rad, by which the joint now lies beyond an edge that had no row in the last step.
  double missed() const;

 private:
  void set_rows(const std::vector<LimitRow>& rows);
  void prepare_edges(double h, const Reach& reach, bool all);
  void prepare_chords();
  void prepare_euler();
  dJointID motor(std::size_t i);

  OdeWorld& world_;
  const Model& model_;
  const ModelJoint& joint_;
  Limits kind_;
  std::vector<dJointID> motors_;
  std::vector<LimitRow> rows_, present_;
  bool complete_ = true;
};

/// The active restriction of one joint: T_f = -k I omega on each axis whose speed is above its threshold
/// (Era et al., section 4.2, eq. (1): T_f torque, N m; k 1/s; I of the child about the axis, kg m^2; omega
/// rad/s).
class ActiveLimit {
 public:
  ActiveLimit(OdeWorld& world, const Model& model, const ModelJoint& joint, Active kind, double k,
              const Vec3& threshold);

  /// Implicit: a motor with target speed 0 and CFM = 1 / (k I). Explicit: a torque on the child, the opposite
  /// on the parent. Off while `enabled` is false.
  void prepare(bool enabled);

 private:
  const Model& model_;
  const ModelJoint& joint_;
  Active kind_;
  double k_;
  Vec3 threshold_;
  dJointID motor_ = nullptr;
};

/// Explicit torques explode where k h is beyond this (k 1/s, h s).
inline constexpr double kMaxExplicitGain = 0.1;

/// Joint damping: -k I omega on the child, the opposite on the parent; I of the lighter of the two.
void apply_damping(const Model& model, const ModelJoint& joint, double k);

/// True when ODE's motor treats a stop ahead as "at most the remaining distance in this step", which the
/// look-ahead rows need (StopERP -1; undocumented, ODE 0.16.2).
bool look_ahead_works();

}  // namespace ukemi
