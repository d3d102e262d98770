// The engine beside closed forms of the same semi-implicit steps.
#include <ode/ode.h>

#include <cmath>
#include <optional>

#include "physics/collision.h"
#include "simulate/figures.h"
#include "simulate/hand_on_wrist.h"
#include "physics/restriction.h"
#include "simulate/standing_man.h"

namespace ukemi {
namespace {

using test::StandingMan;

TEST(ClosedForm, ASphereRollsDownARampAsFiveSeventhsOfGravity) {
  constexpr double kSlope = radians(20.0);
  constexpr double kRadius = 0.15;
  constexpr double kStep = 1.0 / 480.0;
  OdeWorld world;
  dWorldSetGravity(world.id(), 0.0, -9.81, 0.0);
  dWorldSetCFM(world.id(), 1e-9);
  StandingMan man;
  for (Rigid& segment : man.segments) segment.translation.y() += 100.0;  // out of the way
  Model model(world, man.body, man.range);
  PerSegment<Vec3> none;
  none.fill(Vec3::Zero());
  model.place(man.segments, none, none);
  Collision collision(world, model, man.body, false);

  const Vec3 down(std::cos(kSlope), -std::sin(kSlope), 0.0);
  const Vec3 normal(std::sin(kSlope), std::cos(kSlope), 0.0);
  const Vec3 start(0.0, 20.0, 0.0);
  const dGeomID ramp = dCreateBox(nullptr, 40.0, 1.0, 4.0);
  const Quat tilt = exp_rotation(Vec3(0.0, 0.0, -kSlope));
  const dQuaternion rotation = {tilt.w(), tilt.x(), tilt.y(), tilt.z()};
  const Vec3 centre = start - (kRadius + 0.5) * normal;
  dGeomSetPosition(ramp, centre.x(), centre.y(), centre.z());
  dGeomSetQuaternion(ramp, rotation);
  collision.add_prop(ramp, nullptr);
  const dBodyID ball = dBodyCreate(world.id());
  dMass mass;
  dMassSetSphereTotal(&mass, 5.0, kRadius);
  dBodySetMass(ball, &mass);
  dBodySetPosition(ball, start.x(), start.y(), start.z());
  collision.add_prop(dCreateSphere(nullptr, kRadius), ball);

  // The contact is soft: the ball's lever arm is shorter by the few micrometres that it sinks in.
  constexpr double kSoft = 5e-5;
  // While the ball sinks into the contact layer it rolls a little less; from then on its speed grows by a h a
  // step.
  const double a = 5.0 / 7.0 * 9.81 * std::sin(kSlope);
  std::optional<double> settled;
  for (int n = 1; n <= 480; ++n) {
    collision.touch(collision.find(), {false, 0.8});
    dWorldStep(world.id(), kStep);
    dJointGroupEmpty(world.contacts());
    const double speed = down.dot(vec3(dBodyGetLinearVel(ball)));
    if (n == 120) settled = speed;
    if (n <= 120 || n % 60 != 0) continue;
    EXPECT_NEAR(-vec3(dBodyGetAngularVel(ball)).z() * kRadius, speed, kSoft * speed)
        << "rolls without slipping";
    EXPECT_NEAR(speed - *settled, a * kStep * (n - 120), kSoft * speed) << n;
  }
  EXPECT_NEAR(*settled, a * kStep * 120, 0.01 * a * kStep * 120);
}

/// The passive restriction of a hand that turns into its limits.
class LimitedHand {
 public:
  double energy() const {
    return kinetic_energy(on_wrist_.hand().mass_kg, on_wrist_.hand().inertia,
                          read_state(on_wrist_.hand().id));
  }
  double excess_now() const {
    return excess(on_wrist_.wrist().range, on_wrist_.model().chart(on_wrist_.wrist()));
  }
  void step(double h) {
    limit_.prepare(h, Reach{0.25, 0.0}, false);
    dWorldStep(on_wrist_.world().id(), h);
  }

 private:
  test::HandOnWrist on_wrist_{Vec3(4.0, 3.0, 12.0)};
  PassiveLimit limit_{on_wrist_.world(), on_wrist_.model(), on_wrist_.wrist(), Limits::edges};
};

TEST(LookAhead, RowsOfAJointInsideItsRangeNeverAddEnergy) {
  LimitedHand wrist;
  double before = wrist.energy();
  const double start = before;
  int stopped = 0;
  for (int n = 0; n < 960; ++n) {
    const bool inside = wrist.excess_now() <= 0.0;
    wrist.step(1.0 / 480.0);
    const double after = wrist.energy();
    if (inside) {
      EXPECT_LE(after, before * (1.0 + 2e-4)  // what the integrator itself adds in free flight
                )
          << n;
    }
    stopped += after < 0.99 * before;
    EXPECT_LT(degrees(wrist.excess_now()), 0.5);
    before = after;
  }
  EXPECT_GT(stopped, 0) << "the hand met its limit";
  EXPECT_LT(before, start);
}

}  // namespace
}  // namespace ukemi
