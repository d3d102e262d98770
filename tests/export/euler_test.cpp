#include "export/euler.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace ukemi {
namespace {

constexpr AxisOrder kOrders[] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};

TEST(Euler, GivesBackAnyRotationInEveryOrder) {
  Random random(7);
  const auto angle = [&] { return random.uniform(-kPi, kPi); };
  for (const AxisOrder& order : kOrders) {
    for (int i = 0; i < 1000; ++i) {
      const Quat wanted = from_euler({angle(), angle(), angle()}, order);
      EXPECT_LT(angle_between(from_euler(to_euler(wanted, order, std::nullopt), order), wanted), 1e-14);
      const Vec3 previous = test::random_vector(random, kPi).cwiseProduct(Vec3(5, 1, 1));
      EXPECT_LT(angle_between(from_euler(to_euler(wanted, order, previous), order), wanted), 1e-13);
    }
  }
}

TEST(Euler, StaysExactInTheNeighbourhoodOfTheGimbal) {
  Random random(7);
  const auto angle = [&] { return random.uniform(-kPi, kPi); };
  for (const AxisOrder& order : kOrders) {
    for (double off = 1e-3; off > 1e-17; off /= 3) {
      const Quat wanted = from_euler({angle(), kPi / 2 - off, angle()}, order);
      const Vec3 previous = test::random_vector(random, kPi);
      EXPECT_LT(angle_between(from_euler(to_euler(wanted, order, previous), order), wanted), 1e-10) << off;
    }
  }
}

TEST(Euler, FollowsAPathThroughTheGimbalWithoutAJump) {
  for (const AxisOrder& order : kOrders) {
    Vec3 last(0.3, 0.0, -0.2);
    for (int i = 0; i <= 400; ++i) {
      const Vec3 wanted(0.3 + 0.01 * i, 0.01 * kPi * i, -0.2);  // the middle axis goes round twice
      const Vec3 angles = to_euler(from_euler(wanted, order), order, last);
      EXPECT_LT((angles - last).norm(), 0.1) << i;
      last = angles;
    }
    EXPECT_NEAR(last[1], 4 * kPi, 1e-9);
  }
}

}  // namespace
}  // namespace ukemi
