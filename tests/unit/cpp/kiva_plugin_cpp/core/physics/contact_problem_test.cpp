// SPDX-License-Identifier: Apache-2.0
//
// Contacts with Coulomb friction: a block on the ground, a beam on supports.
#include "core/physics/solver/contact_problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace kiva {
namespace {

constexpr double kMass = 10;  // [kg]
constexpr double kFriction = 0.5;

/// A block that can't turn, on one contact, at that velocity along x, y and z (up).
ContactProblem block(double vx, double vy, double vz) {
  ContactProblem problem;
  problem.add(kFriction);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) problem.a[i][j] = i == j ? 1 / kMass : 0;
  }
  problem.b[0] = vz;
  problem.b[1] = vx;
  problem.b[2] = vy;
  problem.solve();
  return problem;
}

/// A beam that lies on supports at those places along it, and falls at 1 m/s.
ContactProblem beam(const std::vector<double>& supports, double centre) {
  constexpr double kInertia = 2;  // [kg m²]
  ContactProblem problem;
  for (double at : supports) {
    problem.add(0);
    const int i = problem.rows() - 1;
    problem.b[i] = -1;
    for (int j = 0; j <= i; ++j) {
      problem.a[i][j] = problem.a[j][i] =
          1 / kMass + (at - centre) * (supports[j] - centre) / kInertia;
    }
  }
  problem.solve();
  return problem;
}

TEST(ContactProblem, HoldsWhatFrictionCanHold) {
  const ContactProblem held = block(0.3, -0.3, -1);
  EXPECT_NEAR(held.x[0], kMass, 1e-6);
  EXPECT_NEAR(held.x[1], -0.3 * kMass, 1e-6);
  EXPECT_NEAR(held.x[2], 0.3 * kMass, 1e-6);
}

TEST(ContactProblem, SlidesOnCoulombsCircle) {
  const ContactProblem sliding = block(3, 4, -1);
  EXPECT_NEAR(sliding.x[0], kMass, 1e-6);
  EXPECT_NEAR(sliding.x[1], -0.6 * kFriction * kMass, 1e-6);
  EXPECT_NEAR(sliding.x[2], -0.8 * kFriction * kMass, 1e-6);
}

TEST(ContactProblem, LetsGoOfWhatLeaves) {
  const ContactProblem leaving = block(1, 1, 0.1);
  for (int row = 0; row < 3; ++row) EXPECT_EQ(leaving.x[row], 0);
}

TEST(ContactProblem, SharesALoadByTheLever) {
  const ContactProblem two = beam({-1, 3}, 0);
  EXPECT_NEAR(two.x[0], 0.75 * kMass, 1e-5);
  EXPECT_NEAR(two.x[1], 0.25 * kMass, 1e-5);
}

TEST(ContactProblem, SharesALoadEvenlyAmongMoreThanAreNeeded) {
  const ContactProblem four = beam({-2, -2, 2, 2}, 0);
  for (int row = 0; row < 4; ++row) EXPECT_NEAR(four.x[row], kMass / 4, 1e-5);
}

TEST(ContactProblem, DoesNotPullTheFarEndDown) {
  // The centre is out beyond both supports: the beam tips over the nearer one, off the other.
  const ContactProblem tipping = beam({-1, 0}, 1);
  EXPECT_EQ(tipping.x[0], 0);
  EXPECT_GT(tipping.x[1], 0);
  EXPECT_GT(tipping.b[0] + tipping.a[0][1] * tipping.x[1], 0) << "the far end lifts off";
}

TEST(ContactProblem, FindsOutWhoIsNeededOnceOthersHold) {
  // Held at one end alone, the other, which would have stayed above the ground, sinks in.
  ContactProblem problem = beam({-1, 1}, 0);
  problem.b[0] = -1;
  problem.b[1] = 0.01;
  problem.a[0][1] = problem.a[1][0] = -0.4;
  problem.solve();
  EXPECT_GT(problem.x[0], 0);
  EXPECT_GT(problem.x[1], 0);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(problem.b[i] + problem.a[i][0] * problem.x[0] + problem.a[i][1] * problem.x[1], 0,
                1e-6);
  }
}

}  // namespace
}  // namespace kiva
