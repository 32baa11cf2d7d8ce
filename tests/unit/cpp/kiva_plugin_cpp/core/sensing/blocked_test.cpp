// SPDX-License-Identifier: Apache-2.0
//
// Obstacles in a laser's view stop a robot on the grid, without contact.
#include "warehouse.h"

namespace kiva::test {
namespace {

/// Returns the least distance between the centres of two robots while the world runs [m].
double closest(Warehouse& w, int a, int b, double seconds) {
  double least = 1e9;
  w.run(seconds, [&] { least = std::min(least, std::hypot(w.x(a) - w.x(b), w.y(a) - w.y(b))); });
  return least;
}

class StandingObstacle : public ::testing::TestWithParam<const char*> {};

TEST_P(StandingObstacle, StopsTheRobotOneCellBefore) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  const std::string kind = GetParam();
  w.spawn(kind, kind == "kiva" ? "kiva2" : kind + "1", 6, 0, kQuarter);
  w.movx(1, 10);
  w.runUntilIdle(1);
  w.expectAt(1, 5, 0);
  EXPECT_EQ(w.count(Event::Kind::kBlocked, "kiva1"), 1);
  EXPECT_EQ(w.count(Event::Kind::kDone, "kiva1"), 0);
  EXPECT_EQ(w.last(Event::Kind::kBlocked).other, kind == "kiva" ? "kiva2" : kind + "1");
  EXPECT_EQ(w.count(Event::Kind::kCollision), 0);
}
INSTANTIATE_TEST_SUITE_P(Kinds, StandingObstacle, ::testing::Values("kiva", "wall", "person"));

TEST(Blocked, ByABeltBeforeItsEnd) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawn("conveyor_belt", "conveyor_belt1", 6.5, 0);  // 1.8 m long: from x = 5.6
  w.movx(1, 10);
  w.runUntilIdle(1);
  w.expectAt(1, 5, 0);
  EXPECT_EQ(w.last(Event::Kind::kBlocked).other, "conveyor_belt1");
}

TEST(Blocked, AtOnceByWhatIsInTheNextCell) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawn("kiva", "kiva2", 1, 0);
  w.movx(1, 1);
  EXPECT_LT(w.runUntilIdle(1), 0.01);
  w.expectAt(1, 0, 0);
  EXPECT_EQ(w.count(Event::Kind::kBlocked, "kiva1"), 1);
}

TEST(Blocked, ReportsBlockedThenIdleAndTakesTheNextCommand) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawn("wall", "wall1", 6, 0, kQuarter);
  w.movx(1, 10);
  w.runUntilIdle(1);
  const std::vector<State> expected{State::kIdle, State::kMovingX, State::kBlocked, State::kIdle};
  EXPECT_EQ(w.statesOf(1), expected);
  w.mov(1, 5, 3);
  w.runUntilIdle(1);
  w.expectAt(1, 5, 3);
}

TEST(Blocked, NotByWhatIsBeyondTheGoal) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawn("wall", "wall1", 6, 0, kQuarter);
  w.movx(1, 5);
  w.runUntilIdle(1);
  w.expectAt(1, 5, 0);
  EXPECT_EQ(w.count(Event::Kind::kDone, "kiva1"), 1);
}

TEST(Blocked, NotByWhatStandsInTheNextLane) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  for (int x = 1; x < 8; ++x) {
    w.spawn("kiva", "kiva" + std::to_string(10 + x), x, 1, x * kQuarter);
    w.spawn("kiva", "kiva" + std::to_string(20 + x), x, -1, x * kQuarter);
  }
  w.movx(1, 8);
  w.runUntilIdle(1);
  w.expectAt(1, 8, 0);
}

TEST(Blocked, NotByUnitsForARobotWithoutALoad) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  for (int i = 1; i <= 5; ++i) w.spawn("storage_unit", "storage_unit" + std::to_string(i), i, 0);
  w.mov(1, 3, 0);
  w.runUntilIdle(1);
  w.mov(1, 3, 2);  // turns beneath a unit, too
  w.runUntilIdle(1);
  w.expectAt(1, 3, 2);
  EXPECT_EQ(w.count(Event::Kind::kBlocked), 0);
  EXPECT_EQ(w.count(Event::Kind::kCollision), 0);
}

TEST(Blocked, ByUnitsForALoadedRobot) {
  Warehouse w;
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  w.spawn("storage_unit", "storage_unit2", 6, 0);
  w.spawn("kiva", "kiva1", 0, 0);
  w.carry(1, 1);
  w.runUntilIdle(1);
  w.movx(1, 10);
  w.runUntilIdle(1);
  w.expectAt(1, 5, 0);
  EXPECT_EQ(w.last(Event::Kind::kBlocked).other, "storage_unit2");
  EXPECT_EQ(w.count(Event::Kind::kCollision), 0);
}

TEST(Blocked, ByAUnitThatAnotherRobotCarries) {
  Warehouse w;
  w.spawn("storage_unit", "storage_unit1", 6, 0);
  w.spawn("kiva", "kiva2", 6, 0);
  w.spawn("kiva", "kiva1", 0, 0);
  w.carry(2, 1);
  w.runUntilIdle(2);
  w.movx(1, 10);
  w.runUntilIdle(1);
  w.expectAt(1, 5, 0);
  EXPECT_EQ(w.count(Event::Kind::kCollision), 0);
}

class HeadOn : public ::testing::TestWithParam<int> {};

TEST_P(HeadOn, BothStopWithoutTouchingAndOnTheGrid) {
  Warehouse w;
  const int between = GetParam();
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawn("kiva", "kiva2", between, 0, M_PI);
  w.movx(1, between);
  w.movx(2, -between);
  EXPECT_GT(closest(w, 1, 2, 20), 0.76);
  EXPECT_EQ(w.count(Event::Kind::kCollision), 0);
  EXPECT_EQ(w.count(Event::Kind::kBlocked), 2);
  if (between < 6) return;  // there they see each other too late for a grid point
  w.expectOnGrid(1);
  w.expectOnGrid(2);
}
INSTANTIATE_TEST_SUITE_P(Distances, HeadOn, ::testing::Range(1, 21));

TEST(Blocked, BothLoadedAndHeadOn) {
  Warehouse w;
  for (int i : {1, 2}) {
    w.spawn("storage_unit", "storage_unit" + std::to_string(i), i == 1 ? 0 : 12, 0);
    w.spawn("kiva", "kiva" + std::to_string(i), i == 1 ? 0 : 12, 0, i == 1 ? 0 : M_PI);
    w.carry(i, i);
  }
  w.run(3);
  w.movx(1, 12);
  w.movx(2, -12);
  EXPECT_GT(closest(w, 1, 2, 20), 0.80);
  EXPECT_EQ(w.count(Event::Kind::kCollision), 0);
  EXPECT_EQ(w.count(Event::Kind::kBlocked), 2);
}

TEST(Blocked, NeverTouchesOneThatCrossesFarEnoughAhead) {
  for (int crossing = 4; crossing <= 8; ++crossing) {
    for (double delay = 0; delay < 3; delay += 0.5) {
      Warehouse w;
      w.spawn("kiva", "kiva1", 0, 0);
      w.spawn("kiva", "kiva2", crossing, -1, kQuarter);
      w.movx(1, 10);
      w.run(delay);
      // Near enough for its whole way across to be seen from a stopping distance.
      if (crossing - w.x(1) < 3.0) continue;
      w.movy(2, 5);
      closest(w, 1, 2, 15);
      EXPECT_EQ(w.count(Event::Kind::kCollision), 0)
          << "crossing at x = " << crossing << ", " << delay << " s after";
    }
  }
}

TEST(Blocked, NotByOneThatComesIntoViewFromTheSideBeyondTheGoal) {
  for (int i = 0; i < 150; ++i) {
    const double delay = 1.55 + i * 0.001;  // whatever face or corner of it is seen first
    Warehouse w;
    w.spawn("kiva", "kiva1", -2, -3);
    w.spawn("kiva", "kiva2", 0, 2, -kQuarter);
    w.movx(1, 2);
    w.run(delay);
    w.movy(2, -1);
    w.runUntilIdle(2);
    EXPECT_EQ(w.count(Event::Kind::kBlocked, "kiva2"), 0) << delay << " s later";
  }
}

TEST(Blocked, GoesOnWhereTheWayIsFreeAgain) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawn("kiva", "kiva2", 8, -1, kQuarter);
  w.movy(2, 4);  // is gone before kiva1 has to brake
  w.movx(1, 10);
  w.runUntilIdle(1);
  w.expectAt(1, 10, 0);
}

TEST(Blocked, FollowsARobotThatDrivesAhead) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawn("kiva", "kiva2", 2, 0);
  w.movx(2, 10);
  w.movx(1, 10);
  EXPECT_GT(closest(w, 1, 2, 20), 0.76);
  EXPECT_EQ(w.count(Event::Kind::kCollision), 0);
}

}  // namespace
}  // namespace kiva::test
