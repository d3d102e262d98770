// Bullet as a peer: a ragdoll of the same body, hit by the same ball.
#pragma once

#include "physics/scene.h"
#include "prepare/prepared.h"
#include "sample.h"

namespace ukemi {

/// Whether this build knows Bullet.
bool has_bullet();

/// The body of `prepared` limp in Bullet, steps of 1/1000 s: the same masses, inertias, joint places, shapes
/// and ball. Joints are cone-twists as wide as the ranges' bounding boxes, elbows and knees hinges (limits of
/// a slit's width make Bullet's cones explode); the rest is as Bullet has it of itself. Samples are joints x
/// steps, judged in the ranges of `prepared` and, as over_own_1deg, in the limits that Bullet was given.
/// Contract: the scene is a ball, and has_bullet().
Sample bullet_sample(const Prepared& prepared, const Scene& scene, int hit, double duration_s);

}  // namespace ukemi
