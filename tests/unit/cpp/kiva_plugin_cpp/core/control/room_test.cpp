// SPDX-License-Identifier: Apache-2.0
//
// Storage units that stand askew. A robot that can't pass or turn beneath one stops before it
// touches it; a robot stopped beneath others returns to the grid between their legs.
#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;

constexpr double kLegroom = 0.04;  // [m] between a robot's side and a leg of a unit in its place

TEST(Room, ARobotPassesBeneathAUnitThatStandsALittleAside) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawn("storage_unit", "storage_unit1", 3, kLegroom - 0.01);
  w.movx(1, 6);
  w.runUntilIdle(1);
  w.expectAt(1, 6, 0);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
}

TEST(Room, ARobotStopsBeforeAUnitWithALegInItsLane) {
  for (double aside : {kLegroom + 0.01, 0.2}) {
    Warehouse w;
    w.spawn("kiva", "kiva1", 0, 0);
    w.spawn("storage_unit", "storage_unit1", 4, aside);
    w.movx(1, 8);
    w.runUntilIdle(1);
    w.expectOnGrid(1);
    EXPECT_GT(w.x(1), 1.9);
    EXPECT_EQ(w.last(Kind::kBlocked).other, "storage_unit1");
    EXPECT_EQ(w.count(Kind::kCollision), 0);
    EXPECT_NEAR(w.unitPose(1).Y(), aside, 1e-9);
  }
}

TEST(Room, ARobotTurnsBeneathAUnitInItsPlaceAndNotBeneathOneAskew) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawn("kiva", "kiva2", 5, 0);
  w.spawn("storage_unit", "storage_unit1", 0.005, 0);
  w.spawn("storage_unit", "storage_unit2", 5.03, 0);
  w.rot(1, kLeft);
  w.rot(2, kLeft);
  w.runUntilIdle(1);
  w.runUntilIdle(2);
  EXPECT_EQ(w.count(Kind::kDone, "kiva1"), 1);
  EXPECT_EQ(w.count(Kind::kBlocked, "kiva2"), 1);
  EXPECT_EQ(w.last(Kind::kBlocked).text, "storage_unit2 leaves no room to turn");
  w.movx(2, 3);  // out it gets
  w.runUntilIdle(2);
  w.expectAt(2, 8, 0);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
}

/// Nine units in their places, and a robot beneath them that something stopped between two grid
/// points, or pushed a little aside, or while it turned.
struct Strewn {
  double x, y, yaw;
};

class AmongUnits : public ::testing::TestWithParam<Strewn> {};

TEST_P(AmongUnits, ARobotGetsBackToTheGridWithoutTouchingALeg) {
  Warehouse w;
  for (int k = 0; k < 9; ++k) {
    w.spawn("storage_unit", "storage_unit" + std::to_string(k + 1), k % 3, k / 3);
  }
  const Strewn& at = GetParam();
  w.spawn("kiva", "kiva1", at.x, at.y, at.yaw);
  w.movy(1, 4);
  w.runUntilIdle(1);
  w.expectOnGrid(1);
  EXPECT_EQ(w.count(Kind::kDone, "kiva1"), 1);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
}

INSTANTIATE_TEST_SUITE_P(Strewn, AmongUnits,
                         ::testing::Values(Strewn{1.5, 1, 0}, Strewn{1.3, 1.02, 0},
                                           Strewn{0.99, 0.97, 0}, Strewn{1, 1.4, kQuarter},
                                           Strewn{1.01, 1, 0.3}, Strewn{1.6, 1.01, M_PI}));

TEST(Room, ARobotThatIsWedgedIsToldSoUntilAUnitIsMoved) {
  Warehouse w;
  w.spawn("storage_unit", "storage_unit1", 1.1, 0.38);   // a leg before it
  w.spawn("storage_unit", "storage_unit2", -0.5, 0.38);  // and one behind
  w.spawn("kiva", "kiva1", 0.3, 0);
  for (int tries = 0; tries < 20; ++tries) {
    w.movx(1, 3);
    w.run(0.01);
  }
  EXPECT_EQ(w.count(Kind::kRefused), 20);
  EXPECT_PRED2(contains, w.last(Kind::kRefused).text, "it reaches no free grid point nearby");
  EXPECT_EQ(w.count(Kind::kCollision), 0);
  w.world.setState("storage_unit1", {Pose(5, 5, 0, 0, 0, 0), {}});
  w.movx(1, 3);
  w.runUntilIdle(1);
  w.expectOnGrid(1);
  EXPECT_EQ(w.count(Kind::kDone, "kiva1"), 1);
}

}  // namespace
}  // namespace kiva::test
