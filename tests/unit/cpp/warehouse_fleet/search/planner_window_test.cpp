// SPDX-License-Identifier: Apache-2.0
//
// Few robots planned in windows of many ticks: plans are right, robots get to their goals sooner,
// past each other in a passage, and again after something went otherwise.
#include "planner_errands.h"

namespace fleet::test {
namespace {

EpibtOptions windowed(int ticks) {
  EpibtOptions options = passing();
  options.window = ticks;
  return options;
}

Rules withRings(bool rings) {
  Rules rules;
  rules.rings = rings;
  return rules;
}

class Window : public testing::TestWithParam<bool> {};

TEST_P(Window, BringsMoreToTheirGoals) {
  const Rules rules = withRings(GetParam());
  Errands by_operations(kScattered, 24, rules, windowed(-1));
  Errands in_windows(kScattered, 24, rules, windowed(15));
  const int before = by_operations.run(300, {0, 300}), now = in_windows.run(300, {0, 300});
  EXPECT_GT(now, 1.02 * before);
}

INSTANTIATE_TEST_SUITE_P(Rings, Window, testing::Bool());

TEST(Window, IsRepeatable) {
  std::vector<std::vector<Cell>> cells;
  for (const int attempts : {200, 200, 0}) {
    Errands errands(kScattered, 24, {}, windowed(15));
    errands.run(60, {0, attempts});
    cells.push_back(errands.fleet.cell);
  }
  EXPECT_EQ(cells[0], cells[1]);
  EXPECT_NE(cells[0], cells[2]);
}

/// Returns where robots are after 60 ticks. ticks: of a window. against: cost of an oncoming robot.
std::vector<Cell> after60(int ticks, double against) {
  EpibtOptions options = windowed(ticks);
  options.against = against;
  Errands errands(kScattered, 24, {}, options);
  errands.run(60, {0, 50});
  return errands.fleet.cell;
}

TEST(Window, CountsOncomingRobotsLess) {
  constexpr int kNone = -1, kAutomatic = -1;
  EXPECT_EQ(after60(15, kAutomatic), after60(15, 3));
  EXPECT_EQ(after60(kNone, kAutomatic), after60(kNone, 10));
  EXPECT_NE(after60(15, 3), after60(15, 10));
  EXPECT_NE(after60(kNone, 3), after60(kNone, 10));
}

TEST(Window, GoesOnAfterStopsThatWereNotPlanned) {
  Errands errands(kScattered, 24, withRings(true), windowed(15));
  std::mt19937_64 random(2);
  int arrivals = 0;
  for (int i = 0; i < 60; ++i) {
    errands.fleet.stopped.assign(errands.fleet.size(), 0);
    if (i % 3 == 0) errands.fleet.stopped[random() % errands.fleet.size()] = 1;
    arrivals += errands.run(2, {0, 50});
  }
  EXPECT_GT(arrivals, 100);
}

TEST(Window, NoRobotDrivesIntoACellThatHasBeenClosed) {
  Errands errands(kScattered, 24, withRings(true), windowed(15));
  const std::vector<Cell> free = cellsOf(kScattered, '.');
  std::mt19937_64 random(4);
  int arrivals = 0;
  for (int i = 0; i < 40; ++i) {
    errands.fleet.closed.clear();
    for (int n = 0; n < 6; ++n) errands.fleet.closed.push_back(free[random() % free.size()]);
    arrivals += errands.run(3, {0, 50});  // validates
  }
  EXPECT_GT(arrivals, 50);
}

TEST(Window, HasRobotsPassEachOtherInAPassage) {
  const std::vector<std::string> rows = {"###.###", ".......", "#######"};
  const Floor floor(drawn(rows));
  Fleet fleet;
  fleet.cell = {7, 13};
  fleet.heading = {0, 2};
  fleet.goal = {13, 7};
  EpibtOptions options = windowed(24);
  options.goals_are_stops = true;
  const auto planner = makeEpibt(options);
  planner->start(floor, {}, 1);
  Plan plan;
  int ticks = 0;
  for (; ticks < 30 && fleet.cell != std::vector<Cell>{13, 7}; ++ticks) {
    planner->plan(fleet, {0, 100}, plan);
    ASSERT_TRUE(validate(floor, fleet, plan, {}).empty());
    for (int robot = 0; robot < fleet.size(); ++robot) {
      const GridPose state =
          after(floor, {fleet.cell[robot], fleet.heading[robot]}, plan.at(robot, 0));
      fleet.cell[robot] = state.cell;
      fleet.heading[robot] = state.heading;
    }
  }
  EXPECT_LT(ticks, 20);
}

TEST(Window, OfMoreTicksThanThereAreIsRefused) {
  EXPECT_THROW(makeEpibt(windowed(32)), FloorError);
  EXPECT_THROW(makeEpibt(windowed(3)), FloorError);
}

}  // namespace
}  // namespace fleet::test
