// A behaviour that cannot harm the run it lives in.
#pragma once

#include <optional>
#include <string>

#include "simulate/controller.h"

namespace ukemi {

/// A behaviour failed. Not an exception of the standard library, so that no other handler catches it.
struct ControllerFailure {
  std::string joint;  // it was about; empty: the whole
  std::string what;   // without the time
};

/// What no muscle can be asked for: numbers that are not finite or above 1e9, rotations that are none, a
/// stiffness, damping or cap below 0, a least torque above the most.
std::optional<ControllerFailure> fault_of(const Goals& goals);

/// The behaviour that `make` makes, or null. Whatever it throws, also while it is made, and goals that
/// fault_of objects to become a ControllerFailure.
std::unique_ptr<Controller> guarded(const MakeController& make);

}  // namespace ukemi
