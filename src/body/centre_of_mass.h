// Where a body's weight is.
#pragma once

#include "body/body.h"

namespace ukemi {

/// Of the whole body, world, m.
Vec3 centre_of_mass(const ArticulatedBody& body, const BodyPose& pose);

}  // namespace ukemi
