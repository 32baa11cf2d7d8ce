// SPDX-License-Identifier: Apache-2.0
//
// Floors with hardly a free cell: all robots get to their goals, by rings, and by coming out of
// dead ends before others go in.
#include "core/floor/pockets.h"
#include "planner_errands.h"

namespace fleet::test {
namespace {

class FullFloor : public testing::TestWithParam<int> {};

TEST_P(FullFloor, NothingStandsStill) {
  Rules rules;
  rules.rings = true;
  const int cells = static_cast<int>(cellsOf(kScattered, '.').size());
  const int robots = GetParam() * cells / 100;
  Errands errands(kScattered, robots, rules);
  const int first = errands.run(250), second = errands.run(250);
  EXPECT_GT(first, robots / 2);
  EXPECT_GT(second, first / 2) << "throughput collapses";
  for (int robot = 0; robot < robots; ++robot) {
    EXPECT_LT(errands.since[robot], 500)
        << "robot " << robot << " on its way from " << errands.floor.name(errands.fleet.cell[robot])
        << " to " << errands.floor.name(errands.fleet.goal[robot]);
  }
}

INSTANTIATE_TEST_SUITE_P(Percent, FullFloor, testing::Values(80, 98));

TEST(FullFloor, MovesWithoutAnyFreeCellByRings) {
  Rules rules;
  rules.rings = true;
  const std::vector<std::string> rows = {"....", "....", "...."};
  Errands errands(rows, 12, rules);
  EXPECT_GT(errands.run(100), 12);
  for (const int since : errands.since) EXPECT_LT(since, 100);
}

TEST(FullFloor, RobotsWithoutAGoalGoWhereTheyArePushed) {
  Rules rules;
  rules.rings = true;
  const int cells = static_cast<int>(cellsOf(kScattered, '.').size());
  const int robots = 98 * cells / 100, with_goals = 30 * cells / 100;
  Errands errands(kScattered, robots, rules);
  std::fill(errands.fleet.goal.begin() + with_goals, errands.fleet.goal.end(), kNowhere);
  const int first = errands.run(250), second = errands.run(250);
  EXPECT_GT(first, with_goals);
  EXPECT_GT(second, first / 2) << "throughput collapses";
  for (int robot = 0; robot < with_goals; ++robot) {
    EXPECT_LT(errands.since[robot], 250) << "robot " << robot;
  }
}

TEST(FullFloor, MovesWithAFewFreeCellsWithoutRings) {
  Errands errands(kScattered, 110, {});
  const int first = errands.run(150), second = errands.run(150);
  EXPECT_GT(first, 10);
  EXPECT_GT(second, first / 2);
}

TEST(FullFloor, RobotsComeOutOfADeadEndBeforeAnotherGoesIn) {
  const std::vector<std::string> rows = {"....#", ".....", "....#"};
  const Floor floor(drawn(rows));
  const Cell inner = 9, before = 8;
  // All cells taken but two; the robot before the dead end is to go in.
  Fleet fleet;
  for (const Cell cell : cellsOf(rows, '.')) {
    if (cell > 1) fleet.cell.push_back(cell);
  }
  const auto at = [&](Cell cell) {
    return std::find(fleet.cell.begin(), fleet.cell.end(), cell) - fleet.cell.begin();
  };
  fleet.heading.assign(fleet.size(), 0);
  fleet.goal.assign(fleet.size(), kNowhere);
  const auto entering = at(before);
  for (int robot = 0; robot < fleet.size(); ++robot) fleet.goal[robot] = fleet.cell[robot];
  fleet.goal[entering] = inner;
  fleet.goal[at(inner)] = 0;
  Rules rules;
  rules.rings = true;
  const auto planner = makeEpibt();
  planner->start(floor, rules, 1);
  Plan plan;
  int ticks = 0;
  for (; fleet.cell[entering] != inner && ticks < 60; ++ticks) {
    planner->plan(fleet, {0, 0}, plan);
    ASSERT_TRUE(validate(floor, fleet, plan, rules).empty());
    for (int robot = 0; robot < fleet.size(); ++robot) {
      const GridPose state =
          after(floor, {fleet.cell[robot], fleet.heading[robot]}, plan.at(robot, 0));
      fleet.cell[robot] = state.cell;
      fleet.heading[robot] = state.heading;
    }
  }
  EXPECT_LT(ticks, 60);
}

/// Drawn as the floor is, 'p' where a pocket is.
std::vector<std::string> withPockets(std::vector<std::string> rows, int most) {
  const auto is_pocket = pockets(Floor(drawn(rows)), most);
  const std::size_t width = rows[0].size();
  for (std::size_t cell = 0; cell < is_pocket.size(); ++cell) {
    if (is_pocket[cell]) rows[cell / width][cell % width] = 'p';
  }
  return rows;
}

TEST(Pockets, AreWhatASingleCellHoldsToTheRest) {
  const std::vector<std::string> rows = {"....#..", ".......", "....###", "###.###"};
  EXPECT_EQ(withPockets(rows, 24),
            (std::vector<std::string>{"....#pp", "....ppp", "....###", "###p###"}));
  EXPECT_EQ(withPockets(rows, 2),
            (std::vector<std::string>{"....#..", ".......", "....###", "###p###"}));
}

TEST(Pockets, AreTheSmallerPart) {
  const std::vector<std::string> halves = {"...#...", ".......", "...#..."};
  for (const std::string& row : withPockets(halves, 24)) {
    EXPECT_EQ(row.find('p'), std::string::npos) << row;
  }
}

TEST(FullFloor, RobotsComeOutOfARoomBehindAPassageBeforeAnotherGoesIn) {
  const std::vector<std::string> rows = {"....#..", ".......", "....###"};
  const Floor floor(drawn(rows));
  const Cell before = 10, inside = 6;
  Fleet fleet;
  for (const Cell cell : cellsOf(rows, '.')) {
    if (cell > 3) fleet.cell.push_back(cell);
  }
  fleet.heading.assign(fleet.size(), 0);
  fleet.goal.assign(fleet.size(), 0);  // all want to where one at a time can be
  const auto entering = std::find(fleet.cell.begin(), fleet.cell.end(), before);
  const auto robot = entering - fleet.cell.begin();
  fleet.goal[robot] = inside;
  EpibtOptions options;
  options.pursuing = 0.01;
  Rules rules;
  rules.rings = true;
  const auto planner = makeEpibt(options);
  planner->start(floor, rules, 1);
  Plan plan;
  int ticks = 0;
  for (; fleet.cell[robot] != inside && ticks < 200; ++ticks) {
    planner->plan(fleet, {0, 0}, plan);
    ASSERT_TRUE(validate(floor, fleet, plan, rules).empty());
    for (int each = 0; each < fleet.size(); ++each) {
      const GridPose state =
          after(floor, {fleet.cell[each], fleet.heading[each]}, plan.at(each, 0));
      fleet.cell[each] = state.cell;
      fleet.heading[each] = state.heading;
      if (state.cell == fleet.goal[each] && each != robot)
        fleet.goal[each] = state.cell == 0 ? 14 : 0;
    }
  }
  EXPECT_LT(ticks, 200);
}

TEST(FullFloor, RefusesAFleetOfWhichNoneMayPursueItsGoal) {
  EpibtOptions options;
  options.pursuing = 0;
  const Floor floor(drawn({"..."}));
  const auto planner = makeEpibt(options);
  EXPECT_THROW(planner->start(floor, {}, 1), FloorError);
}

}  // namespace
}  // namespace fleet::test
