// An ODE world of one's own: created, stepped, torn down, all in one thread. ODE's fatal errors become
// exceptions; a world that threw is never touched again (destroying it would abort), so it is kept until the
// process ends.
#pragma once

#include <stdexcept>

#include "base/math.h"
#include "physics/ode_handles.h"

namespace ukemi {

/// Thrown out of ODE's error and debug handlers.
struct OdeFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Initialises ODE for this process and thread, once.
void initialise_ode();
/// Of a poisoned world: holds what may not be destroyed, so that leak checkers see it as meant.
void keep_for_ever(const void* of_ode);

class OdeWorld {
 public:
  OdeWorld();
  ~OdeWorld();
  OdeWorld(const OdeWorld&) = delete;
  OdeWorld& operator=(const OdeWorld&) = delete;

  dWorldID id() const { return world_; }
  dJointGroupID contacts() const { return contacts_; }
  /// After an OdeFailure since this world was made: this world must not be touched again.
  bool poisoned() const;

 private:
  dWorldID world_;
  dJointGroupID contacts_;
  dThreadingImplementationID threading_;
  long failures_before_;
};

inline Vec3 vec3(const double* v) { return {v[0], v[1], v[2]}; }
inline Quat quat(const double* q) { return {q[0], q[1], q[2], q[3]}; }
void set_quaternion(dBodyID body, const Quat& q);

}  // namespace ukemi
