// SPDX-License-Identifier: Apache-2.0
//
// The planner at work on floors with two decks: no robot blocks another, and all arrive.
#include "planner_shift.h"
#include "warehouse_layout/layout_check.h"

namespace fleet::test {
namespace {

TEST(Epibt, TakesTheShortestWayAlone) {
  const Floor floor(drawn(std::vector<std::string>(20, std::string(30, '.'))));
  const auto planner = makeEpibt();
  planner->start(floor, {}, 1);
  Fleet fleet;
  fleet.cell = {0};
  fleet.heading = {2};
  fleet.goal = {19 * 30 + 29};
  Plan plan;
  int ticks = 0;
  for (; fleet.cell[0] != fleet.goal[0] && ticks < 1000; ++ticks) {
    planner->plan(fleet, {}, plan);
    const GridPose state = after(floor, {fleet.cell[0], fleet.heading[0]}, plan.at(0, 0));
    fleet.cell[0] = state.cell;
    fleet.heading[0] = state.heading;
  }
  // A quarter turn and one between the legs, 29 + 19 cells.
  EXPECT_EQ(ticks, 2 + 29 + 19);
}

class EveryLayout : public testing::TestWithParam<std::tuple<int, int, bool>> {};

TEST_P(EveryLayout, EverybodyArrivesAndNobodyMeets) {
  const auto [seed, aisle, following] = GetParam();
  const auto rows = blocks(5, 4, aisle);
  Rules rules;
  rules.following = following;
  Shift shift(rows, aisle == 1 ? 15 : 25, seed, rules);
  ASSERT_TRUE(checkLayout(shift.floor).empty());
  ASSERT_TRUE(shift.run(400));
  EXPECT_LT(shift.longest, 200) << "a robot was stuck";
  EXPECT_GT(shift.arrivals, shift.fleet.size() * 400 / 100);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryLayout,
                         testing::Combine(testing::Range(1, 4), testing::Values(1, 2, 3),
                                          testing::Bool()));

TEST(Epibt, MovesNobodyAroundInARing) {
  // Four in a square, each with the next one's cell as its goal and facing it.
  const Floor floor(drawn({"....", "....", "...."}));
  Fleet fleet;
  fleet.cell = {0, 1, 5, 4};
  fleet.heading = {0, 1, 2, 3};
  fleet.goal = {1, 5, 4, 0};
  for (const bool rings : {false, true}) {
    Rules rules;
    rules.rings = rings;
    const auto planner = makeEpibt();
    planner->start(floor, rules, 1);
    Plan plan;
    planner->plan(fleet, {0, 200}, plan);
    EXPECT_TRUE(validate(floor, fleet, plan, rules).empty());
    int moving = 0;
    for (int robot = 0; robot < 4; ++robot) moving += plan.at(robot, 0) == Action::kForward;
    if (rings) {
      EXPECT_EQ(moving, 4);
    } else {
      EXPECT_LT(moving, 4);
    }
  }
}

TEST(Epibt, DrivesAroundADeadRobotAndAClosedCell) {
  for (const int seed : {1, 2}) {
    Shift shift(blocks(5, 4, 2), 25, seed);
    ASSERT_TRUE(shift.run(100));
    shift.fleet.stopped[3] = shift.fleet.stopped[8] = 1;
    const Cell crossing = 13 * shift.floor.width() / 2;
    for (const Cell cell : {crossing, crossing + 1}) {
      const auto& cells = shift.fleet.cell;
      if (std::find(cells.begin(), cells.end(), cell) == cells.end() &&
          !shift.floor.isStorage(cell)) {
        shift.fleet.closed.push_back(cell);
      }
    }
    const int before = shift.arrivals;
    ASSERT_TRUE(shift.run(300));
    EXPECT_GT(shift.arrivals, before + 23 * 300 / 100);
    shift.fleet.closed.clear();
    shift.fleet.stopped.assign(25, 0);
    ASSERT_TRUE(shift.run(300));
    for (const int since : shift.since()) EXPECT_LT(since, 250) << "flows again for all";
  }
}

TEST(Epibt, KeepsOutOfAZoneAndLeavesItWithoutEnteringAgain) {
  Shift shift(blocks(5, 4, 2), 25, 1);
  const int width = shift.floor.width(), row = 13;
  std::vector<Cell> zone;
  for (int y = row; y < row + 2; ++y) {
    for (int x = 6; x < 12; ++x) zone.push_back(y * width + x);
  }
  const auto isInside = [&](Cell cell) {
    return std::find(zone.begin(), zone.end(), cell) != zone.end();
  };
  // Two robots begin inside, in the middle, with neighbours that are closed on all sides.
  const auto place = [&](int robot, Cell cell) {
    const auto& cells = shift.fleet.cell;
    if (std::find(cells.begin(), cells.end(), cell) == cells.end()) shift.fleet.cell[robot] = cell;
  };
  place(0, row * width + 8);
  place(1, (row + 1) * width + 9);
  shift.fleet.zone = zone;
  std::vector<std::uint8_t> was(25);
  for (int robot = 0; robot < 25; ++robot) was[robot] = isInside(shift.fleet.cell[robot]);
  ASSERT_GT(std::count(was.begin(), was.end(), 1), 0);
  for (int tick = 0; tick < 150; ++tick) {
    for (int robot = 0; robot < 25; ++robot) {  // a goal inside would keep a robot there
      if (isInside(shift.fleet.goal[robot])) shift.fleet.goal[robot] = kNowhere;
    }
    ASSERT_TRUE(shift.run(1)) << "the validator sees none that enters";
    for (int robot = 0; robot < 25; ++robot) {
      const bool is = isInside(shift.fleet.cell[robot]);
      EXPECT_FALSE(is && !was[robot]) << "robot " << robot << " entered in tick " << tick;
      was[robot] = is;
    }
  }
}

TEST(Epibt, LeavesTheMiddleOfAZoneAndDrivesAroundItFromOutside) {
  FloorDescription open = drawn(std::vector<std::string>(7, "......."));
  const Floor floor(open);
  Fleet fleet;
  fleet.cell = {3 * 7 + 3, 3 * 7};  // in the middle; beside the zone, with the goal beyond it
  fleet.heading = {0, 0};
  fleet.goal = {0, 3 * 7 + 6};
  for (int y = 1; y < 6; ++y) {
    for (int x = 1; x < 6; ++x) fleet.zone.push_back(y * 7 + x);
  }
  const auto planner = makeEpibt();
  planner->start(floor, {}, 1);
  Plan plan;
  for (int tick = 0; tick < 40; ++tick) {
    planner->plan(fleet, {}, plan);
    EXPECT_TRUE(validate(floor, fleet, plan, {}).empty());
    for (int robot = 0; robot < 2; ++robot) {
      const GridPose state{fleet.cell[robot], fleet.heading[robot]};
      const GridPose next = after(floor, state, plan.at(robot, 0));
      fleet.cell[robot] = next.cell;
      fleet.heading[robot] = next.heading;
    }
  }
  EXPECT_EQ(fleet.cell, fleet.goal);
}

/// One-way streets: along the bottom, up the right side, back along the top, down the left side.
FloorDescription loop() {
  FloorDescription floor = drawn({"....", ".##.", "...."});
  floor.exits = {1, 1, 1, 2, 8, 0xf, 0xf, 2, 8, 4, 4, 4};
  return floor;
}

/// Drives until a robot is at its goal, or for `most` ticks. Returns the number of ticks.
int ticksTo(const Floor& floor, Fleet& fleet, int most, int who = 0) {
  const auto planner = makeEpibt();
  planner->start(floor, {}, 1);
  Plan plan;
  int ticks = 0;
  for (; fleet.cell[who] != fleet.goal[who] && ticks < most; ++ticks) {
    planner->plan(fleet, {}, plan);
    for (int robot = 0; robot < fleet.size(); ++robot) {
      const GridPose state{fleet.cell[robot], fleet.heading[robot]};
      const GridPose next = after(floor, state, plan.at(robot, 0));
      fleet.cell[robot] = next.cell;
      fleet.heading[robot] = next.heading;
    }
  }
  return ticks;
}

TEST(Epibt, TurnsBackInAOneWayStreetThatIsCut) {
  const Floor floor(loop());
  Fleet fleet;
  fleet.cell = {2};
  fleet.heading = {0};
  fleet.goal = {0};
  fleet.loaded = {1};
  Fleet open = fleet;
  EXPECT_EQ(ticksTo(floor, open, 100), 11) << "around";
  for (const bool is_unit : {false, true}) {
    Fleet shut = fleet;
    (is_unit ? shut.units : shut.closed) = {3};
    const int ticks = ticksTo(floor, shut, 100);
    EXPECT_GT(ticks, 14) << "waits whether it goes away";
    EXPECT_LT(ticks, 25) << "turns, and drives two cells back";
  }
}

TEST(Epibt, ComesToAUnitInALaneFromBeyondWhereALoadedRobotWaitsBehindIt) {
  FloorDescription lane = loop();
  lane.lane = {0, 1, 1, 1, 0, 0, 0, 1, 0, 0, 1, 1};
  const Floor floor(lane);
  Fleet fleet;
  fleet.cell = {0, 2};
  fleet.heading = {0, 0};
  fleet.goal = {3, 9};
  fleet.loaded = {0, 1};
  fleet.units = {3};
  EXPECT_LT(ticksTo(floor, fleet, 100), 40) << "around, against the lane";
  EXPECT_EQ(fleet.cell[1], 2);
}

TEST(Epibt, TurnsNoLoadWhereThereIsNoRoom) {
  const Floor floor(drawn({".....", ".###.", "....."}));
  const Cell corner = 4, goal = 9;
  for (const bool is_loaded : {false, true}) {
    const auto planner = makeEpibt();
    planner->start(floor, {}, 1);
    Fleet fleet;
    fleet.cell = {0};
    fleet.heading = {0};
    fleet.goal = {goal};
    fleet.loaded = {is_loaded};
    fleet.tight = {corner};
    Plan plan;
    int ticks = 0;
    for (; fleet.cell[0] != goal && ticks < 100; ++ticks) {
      planner->plan(fleet, {}, plan);
      const GridPose state = after(floor, {fleet.cell[0], fleet.heading[0]}, plan.at(0, 0));
      fleet.cell[0] = state.cell;
      fleet.heading[0] = state.heading;
    }
    EXPECT_EQ(ticks, is_loaded ? 1 + 2 + 1 + 4 + 1 + 1 : 4 + 1 + 1);
  }
}

TEST(Epibt, LetsInWhoWaitsBesideAStream) {
  // One street downwards, on which robots follow each other and begin again; one comes from aside.
  constexpr int kLength = 61, kMiddle = 30;
  FloorDescription street;
  street.width = 2;
  street.height = kLength;
  const auto at = [](int x, int y) { return y * 2 + x; };
  street.passable.assign(2 * kLength, 0);
  street.exits.assign(2 * kLength, 1 << 1);
  Fleet fleet;
  for (int y = 0; y < kLength; ++y) {
    street.passable[at(1, y)] = 1;
    if (y % 2 == 0 && y < kLength - 2) fleet.cell.push_back(at(1, y));
  }
  street.passable[at(0, kMiddle)] = street.exits[at(0, kMiddle)] = 1;
  const Floor floor(street);
  fleet.goal.assign(fleet.cell.size(), at(1, kLength - 1));
  fleet.cell.push_back(at(0, kMiddle));
  fleet.goal.push_back(at(1, kLength - 2));
  fleet.heading.assign(fleet.cell.size(), 1);
  const auto isFree = [&](Cell cell) {
    return std::count(fleet.cell.begin(), fleet.cell.end(), cell) == 0;
  };
  EpibtOptions braking;
  braking.turn_ticks = 2;
  braking.pursuing = 1;  // ranks alone decide: none of those in the stream ever arrives, and yields
  const auto planner = makeEpibt(braking);
  planner->start(floor, {}, 1);
  Plan plan;
  int ticks = 0;
  for (; fleet.cell.back() == at(0, kMiddle) && ticks < 100; ++ticks) {
    planner->plan(fleet, {}, plan);
    for (int robot = 0; robot < fleet.size(); ++robot) {
      const GridPose state =
          after(floor, {fleet.cell[robot], fleet.heading[robot]}, plan.at(robot, 0));
      fleet.cell[robot] = state.cell;
      fleet.heading[robot] = state.heading;
    }
    for (int robot = 0; robot + 1 < fleet.size(); ++robot) {
      const bool is_through = fleet.cell[robot] >= at(0, kLength - 4);
      if (is_through && isFree(at(1, 0)) && isFree(at(1, 1))) fleet.cell[robot] = at(1, 0);
    }
  }
  EXPECT_LT(ticks, 15);
}

TEST(Epibt, LetsOutWhoIsShutInHoweverManyWaitInQueues) {
  // In each queue a robot waits for one that is served, which can't be hurried. Below them a robot
  // with a unit comes out of its storage place, before which another waits to drive beneath it.
  constexpr int kQueues = 24, kServed = 7;
  std::string queues, walls(3 * kQueues, '#'), aisle(3 * kQueues, '.'), places = walls;
  for (int queue = 0; queue < kQueues; ++queue) queues += "..#";
  places[5] = 'S';
  const Floor floor(drawn({queues, walls, aisle, places, places}));
  const Cell shut_in = 3 * floor.width() + 5, before = shut_in - floor.width();
  Fleet fleet;
  fleet.committed_ticks = kServed;
  const auto add = [&](Cell cell, Cell goal, bool is_loaded, bool is_served) {
    fleet.cell.push_back(cell);
    fleet.goal.push_back(goal);
    fleet.loaded.push_back(is_loaded);
    const auto wait = static_cast<std::uint8_t>(Action::kWait);
    fleet.committed.insert(fleet.committed.end(), kServed, is_served ? wait : Fleet::kFree);
  };
  for (Cell first = 0; first < 3 * kQueues; first += 3) {
    add(first, first + 1, true, false);
    add(first + 1, first + 1, true, true);
  }
  add(shut_in, before + 60, true, false);
  add(before, shut_in + floor.width(), false, false);
  fleet.heading.assign(fleet.cell.size(), 0);
  EXPECT_LT(ticksTo(floor, fleet, 300, 2 * kQueues), 120);
}

TEST(Epibt, DrivesAroundOneThatRestsWhereItWasToGo) {
  const std::vector<std::string> rows(3, "............");
  const Floor floor(drawn(rows));
  const Cell begin = 12, between = 12 + 5, end = 12 + 11;
  Fleet fleet;
  fleet.cell = {begin, between};
  fleet.heading = {0, 0};
  fleet.goal = {end, between};
  EpibtOptions options;
  options.resting = 8;
  const auto planner = makeEpibt(options);
  planner->start(floor, {}, 1);
  Plan plan;
  int ticks = 0;
  for (; fleet.cell[0] != end && ticks < 100; ++ticks) {
    planner->plan(fleet, {}, plan);
    for (int robot = 0; robot < 2; ++robot) {
      const GridPose state =
          after(floor, {fleet.cell[robot], fleet.heading[robot]}, plan.at(robot, 0));
      fleet.cell[robot] = state.cell;
      fleet.heading[robot] = state.heading;
    }
    ASSERT_EQ(fleet.cell[1], between);
  }
  EXPECT_LE(ticks, 11 + 2 + 4);  // a cell aside and back, four quarter turns
}

TEST(Epibt, KeepsWhatIsCommittedAndGoesOnFromWhereRobotsAre) {
  // Robots that deviate from the plan: each misses one action in ten.
  std::mt19937_64 random(5);
  Shift shift(blocks(5, 4, 2), 25, 5);
  for (int tick = 0; tick < 300; ++tick) {
    for (auto& stopped : shift.fleet.stopped) stopped = random() % 10 == 0;
    ASSERT_TRUE(shift.step());
  }
  EXPECT_GT(shift.arrivals, 25 * 300 / 150);
}

TEST(Epibt, NobodyIsPushedPastItsGoalByWhoGoesThereToo) {
  const Floor floor(drawn({"........"}));
  Fleet fleet;
  fleet.cell = {0, 1};
  fleet.heading = {0, 0};
  fleet.goal = {3, 7};
  fleet.stopped = {1, 1};
  const auto planner = makeEpibt();
  planner->start(floor, {}, 1);
  Plan plan;
  for (int tick = 0; tick < 20; ++tick) planner->plan(fleet, {}, plan);
  fleet.stopped = {0, 0};
  fleet.goal = {3, 3};  // the one behind has waited for long, the other not at all
  for (int tick = 0; tick < 5; ++tick) {
    planner->plan(fleet, {}, plan);
    for (int robot = 0; robot < 2; ++robot) {
      if (plan.at(robot, 0) == Action::kForward) ++fleet.cell[robot];
    }
    EXPECT_LE(fleet.cell[1], 3);
  }
  EXPECT_EQ(fleet.cell[1], 3);
}

TEST(Epibt, SearchChangesPlansAndIsRepeatable) {
  std::vector<std::vector<Cell>> cells;
  for (const int attempts : {0, 300, 300}) {
    Shift shift(blocks(5, 4, 1), 15, 9);
    ASSERT_TRUE(shift.run(200, {0, attempts}));
    cells.push_back(shift.fleet.cell);
  }
  EXPECT_EQ(cells[1], cells[2]);
  EXPECT_NE(cells[0], cells[1]);
}

TEST(Epibt, TakesNoLongerThanItIsGiven) {
  Shift shift(blocks(5, 4, 2), 40, 2);
  timespec begin, end;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
  ASSERT_TRUE(shift.run(50, {0.004, -1}));
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
  const double seconds = end.tv_sec - begin.tv_sec + 1e-9 * (end.tv_nsec - begin.tv_nsec);
  EXPECT_GE(seconds, 50 * 0.004);
  EXPECT_LT(seconds, 50 * 0.008);
}

TEST(Epibt, AGoalThatIsCutOffStopsNobodyElse) {
  Shift shift(blocks(3, 2, 1), 2, 1);
  const Cell goal = shift.floor.size() - 1;
  shift.fleet.cell = {0, 3};
  shift.fleet.goal = {goal, 8};
  shift.fleet.closed = {goal - 1, goal - shift.floor.width()};
  ASSERT_TRUE(shift.run(40));
  EXPECT_GT(shift.arrivals, 0);
}

TEST(Epibt, RefusesAFleetThatCannotBe) {
  const Floor floor(drawn({"..#", "..."}));
  const auto planner = makeEpibt();
  planner->start(floor, {}, 1);
  const auto refusal = [&](std::vector<Cell> cell, std::vector<Cell> goal) -> std::string {
    Fleet fleet;
    fleet.cell = cell;
    fleet.heading.assign(cell.size(), 0);
    fleet.goal = goal;
    Plan plan;
    try {
      planner->plan(fleet, {}, plan);
    } catch (const FloorError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal({0, 1}, {1, 0}), "");
  EXPECT_EQ(refusal({0, 0}, {1, 1}), "robot 0 and robot 1 both stand at (0, 0)");
  EXPECT_EQ(refusal({2}, {1}), "robot 0 stands at (2, 0), where no robot can stand");
  EXPECT_EQ(refusal({0}, {9}),
            "robot 0 has the goal cell 9 (off the floor), where no robot can stand");
  EXPECT_EQ(refusal({0}, {}), "goal has 0 elements; one a robot, 1, was expected");
}

}  // namespace
}  // namespace fleet::test
