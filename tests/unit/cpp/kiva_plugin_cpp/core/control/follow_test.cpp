// SPDX-License-Identifier: Apache-2.0
//
// Paths that are released point by point.
#include <algorithm>

#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

using Points = std::vector<PathPoint>;
using Kind = Event::Kind;

/// Points from (x, y) along x, one a metre.
Points alongX(double x, double y, int count, int way = 1) {
  Points points;
  for (int k = 0; k < count; ++k) points.push_back({x + way * k, y});
  return points;
}

FollowPath path(int id, std::uint32_t path_id, const Points& points, std::uint32_t released,
                std::uint32_t first = 0) {
  FollowPath out;
  out.kiva_id = id;
  out.path_id = path_id;
  out.first = first;
  for (const PathPoint& p : points) {
    out.x.push_back(p.x);
    out.y.push_back(p.y);
  }
  out.released = released;
  return out;
}

class FollowTest : public testing::Test {
 protected:
  void SetUp() override { w.spawn("kiva", "kiva1", 0, 0); }

  void follow(int id, const Points& points, std::uint32_t released, std::uint32_t first = 0) {
    w.world.post(path(id, 7, points, released, first));
  }
  void release(int id, std::uint32_t released) { follow(id, {}, released); }
  void order(Command::Kind kind, int id) {
    Command command;
    command.kind = kind;
    command.kiva_id = id;
    w.world.post(command);
  }
  std::uint32_t reached(int id) const { return w.world.fleet().reached[w.index(id)]; }
  std::uint32_t left(int id) const { return w.world.fleet().left[w.index(id)]; }
  /// Returns the reason with which `change` is refused; expects a refusal that changes nothing.
  std::string refused(const FollowPath& change) {
    w.world.post(change);
    const std::string bytes = w.world.checkpoint();
    World other(parseWorld(worldText({}), modelPaths(), "test"));
    other.restore(bytes);
    insideOf(other).inbox.pending.clear();
    const std::string text = w.refusal();
    other.step();
    EXPECT_FALSE(text.empty());
    EXPECT_EQ(w.world.stateHash(), other.stateHash()) << text;
    return text;
  }

  Warehouse w;
};

TEST_F(FollowTest, PointsReleasedInTimeAreDrivenAsIfAllWereFromTheBeginning) {
  const Points all = alongX(0, 0, 13), same = alongX(0, 3, 13);
  w.spawn("kiva", "kiva2", 0, 3);
  follow(1, all, 13);
  follow(2, {same.begin(), same.begin() + 4}, 4);
  std::uint32_t released = 4;
  double worst = 0, top = 0;
  w.runUntil([&] { return w.status(1) == Status::kIdle && w.status(2) == Status::kIdle; }, 30,
             [&] {
               worst = std::max(worst, std::abs(w.speed(1) - w.speed(2)));
               top = std::max(top, w.speed(2));
               if (released < 13 && reached(2) + 3 > released) {
                 follow(2, {same[released]}, released + 1, released);
                 ++released;
               }
             });
  EXPECT_EQ(released, 13u);
  EXPECT_LT(worst, 1e-9);
  EXPECT_NEAR(top, 1.5, 1e-9);
  w.expectAt(2, 12, 3);
  EXPECT_EQ(w.count(Kind::kDone), 2);
  EXPECT_EQ(w.count(Kind::kRefused), 0);
  const std::vector<Kind> kinds{Kind::kSpawned, Kind::kAccepted, Kind::kDone};
  EXPECT_EQ(w.kindsOf("kiva2"), kinds);
}

TEST_F(FollowTest, CruisesThroughReleases) {
  follow(1, alongX(0, 0, 13), 4);
  w.run(1);
  for (std::uint32_t released = 5; released < 10; ++released) {
    release(1, released);
    w.step();
    EXPECT_NE(insideOf(w.world).fleet.cruising[0], 0) << released;
  }
}

TEST_F(FollowTest, TurnsAtCornersAndWaitsAtTheLastReleasedPoint) {
  follow(1, {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}}, 5);
  w.runUntilState(1, State::kWaiting);
  w.expectAt(1, 2, 2);
  EXPECT_EQ(w.status(1), Status::kBusy);
  EXPECT_EQ(reached(1), 5u);
  EXPECT_EQ(left(1), 4u);
  w.run(0.2);
  EXPECT_EQ(insideOf(w.world).fleet.awake[0], 0) << "a robot that waits costs nothing";
  EXPECT_EQ(w.count(Kind::kDone), 0);
  release(1, 6);
  w.runUntilIdle(1);
  w.expectAt(1, 1, 2);
  w.expectOnGrid(1);
  EXPECT_EQ(w.last(Kind::kDone).command, w.last(Kind::kAccepted).command);
  EXPECT_EQ(reached(1), 6u);
  EXPECT_EQ(left(1), 5u);
  const std::vector<State> states{State::kIdle,    State::kMovingX, State::kRotating,
                                  State::kMovingY, State::kWaiting, State::kRotating,
                                  State::kMovingX, State::kIdle};
  EXPECT_EQ(w.statesOf(1), states);
}

TEST_F(FollowTest, TurnsAroundWhereThePathGoesBack) {
  follow(1, {{0, 0}, {1, 0}, {2, 0}, {1, 0}, {0, 0}}, 5);
  w.runUntilIdle(1);
  w.expectAt(1, 0, 0);
  EXPECT_NEAR(std::abs(std::remainder(w.yaw(1), 2 * M_PI)), M_PI, 1e-5);
  EXPECT_EQ(w.count(Kind::kDone), 1);
}

/// Compares `reached` and `left` with the places of robot and load at every step.
class CountTest : public FollowTest, public testing::WithParamInterface<bool> {};

TEST_P(CountTest, PointsAreReachedAndCellsLeftAsGeometryHasIt) {
  const bool loaded = GetParam();
  if (loaded) {
    w.spawn("storage_unit", "storage_unit1", 0, 0);
    w.carry(1, 1);
    w.runUntilIdle(1);
  }
  const Robot& r = w.robot(1);
  const double half = std::max(r.half_length, r.load_half_length);
  EXPECT_EQ(loaded, half > r.half_length);
  const Points points{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {2, 2}};
  follow(1, points, 3);
  w.step();
  EXPECT_EQ(w.world.fleet().path_id[0], 7u);
  std::uint32_t before = 0;
  w.runUntil([&] { return w.status(1) == Status::kIdle; }, 60,
             [&] {
               if (w.state(1) == State::kWaiting) release(1, 7);
               if (w.state(1) != State::kMovingX && w.state(1) != State::kMovingY) return;
               EXPECT_GE(reached(1), before);
               before = reached(1);
               // The nearest it has come to the next point: it has not been there.
               if (reached(1) < points.size()) {
                 const PathPoint& next = points[reached(1)];
                 EXPECT_GT(std::hypot(w.x(1) - next.x, w.y(1) - next.y), 0.0009);
               }
               const bool along_x = w.state(1) == State::kMovingX;
               const double width = std::max(r.half_width, r.load_half_width);
               const auto isOut = [&](const PathPoint& p, double slack) {
                 return std::abs(w.x(1) - p.x) >= 0.5 + (along_x ? half : width) - slack ||
                        std::abs(w.y(1) - p.y) >= 0.5 + (along_x ? width : half) - slack;
               };
               for (std::uint32_t k = 0; k < left(1); ++k) EXPECT_TRUE(isOut(points[k], 1e-6)) << k;
               if (left(1) < reached(1)) {
                 EXPECT_FALSE(isOut(points[left(1)], -1e-6)) << left(1);
               }
             });
  EXPECT_EQ(reached(1), 7u);
  EXPECT_EQ(left(1), 6u);
}

INSTANTIATE_TEST_SUITE_P(, CountTest, testing::Bool());

TEST_F(FollowTest, WhatMakesNoPathIsRefused) {
  w.spawn("conveyor_belt", "conveyor_belt1", 0, 5);
  w.spawn("wall", "wall1", 0, -3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Points line = alongX(0, 0, 4);
  FollowPath uneven = path(1, 7, line, 2);
  uneven.y.pop_back();
  const std::vector<std::pair<FollowPath, std::string>> cases{
      {path(9, 7, line, 2), "no robot kiva9"},
      {path(1, 0, line, 2), "path_id 0"},
      {uneven, "4 x and 3 y"},
      {path(1, 7, line, 5), "released 5"},
      {path(1, 7, line, 0), "released 0"},
      {path(1, 7, {}, 1), "released 1"},
      {path(1, 7, line, 2, 1), "first 1"},
      {path(1, 7, {{0, 0}, {nan, 0}}, 2), "finite"},
      {path(1, 7, {{0, 0}, {0.5, 0}}, 2), "off the grid"},
      {path(1, 7, {{0, 0}, {1, 1}}, 2), "along one axis"},
      {path(1, 7, {{0, 0}, {0, 0}}, 2), "along one axis"},
      {path(1, 7, {{1, 0}, {2, 0}}, 2), "point 0"},
      {path(1, 7, {{0, 0}, {60, 0}}, 2), "outside the floor"},
      {path(1, 7, {{0, 0}, {0, 9}}, 2), "conveyor_belt1"},
      {path(1, 7, {{0, 0}, {0, -9}}, 2), "wall1"},
  };
  for (const auto& [message, why] : cases) EXPECT_PRED2(contains, refused(message), why);
  EXPECT_EQ(w.count(Kind::kAccepted), 0);
}

TEST_F(FollowTest, AChangeThatCannotBeGrantedLeavesThePathAsItWas) {
  follow(1, alongX(0, 0, 8), 6);
  w.runUntil([&] { return w.x(1) > 2.5; });
  EXPECT_PRED2(contains, refused(path(1, 7, {{3, 1}, {4, 1}}, 6, 4)), "point 4 is released");
  EXPECT_PRED2(contains, refused(path(1, 7, {{6, 2}}, 7, 6)), "along one axis");
  EXPECT_PRED2(contains, refused(path(1, 7, {{9, 0}}, 6, 9)), "first 9");
  EXPECT_PRED2(contains, refused(path(1, 7, {}, 9)), "released 9");
  EXPECT_PRED2(contains, refused(path(1, 7, {}, 4)), "no longer stop");
  EXPECT_PRED2(contains, refused(path(1, 8, alongX(3, 0, 2), 2)), "not idle");
  release(1, 5);  // that can be granted
  w.runUntilState(1, State::kWaiting);
  w.expectAt(1, 4, 0);
  follow(1, {{4, 0}, {4, 1}}, 6, 4);  // another end, from the point where it stands
  w.runUntilIdle(1);
  w.expectAt(1, 4, 1);
  EXPECT_PRED2(contains, refused(path(1, 7, {}, 6)), "over");
}

TEST_F(FollowTest, ShrinkingStopsAtTheNewEndWithUsualBraking) {
  follow(1, alongX(0, 0, 12), 12);
  w.runUntil([&] { return w.x(1) > 2.8; });
  release(1, 5);  // 1.2 m are left of 1.125 m that it needs
  double hardest = 0, before = w.speed(1);
  w.runUntil([&] { return w.state(1) == State::kWaiting; }, 20,
             [&] {
               hardest = std::max(hardest, before - w.speed(1));
               before = w.speed(1);
             });
  w.expectAt(1, 4, 0);
  EXPECT_LT(hardest, 1.2e-3);
}

TEST_F(FollowTest, WaitsBeforeAnObstacleAndGoesOnByItself) {
  w.spawn("person", "person1", 5, 0);
  follow(1, alongX(0, 0, 8), 8);
  w.runUntilState(1, State::kBlocked);
  w.run(3);
  w.expectAt(1, 4, 0);
  EXPECT_EQ(w.status(1), Status::kBlocked);
  EXPECT_EQ(w.last(Kind::kBlocked).other, "person1");
  EXPECT_EQ(w.count(Kind::kBlocked), 1);
  EXPECT_EQ(w.world.fleet().last_end[0], 0);
  EXPECT_EQ(insideOf(w.world).fleet.awake[0], 0);
  w.world.setState("person1", {Pose(5, 3, 0, 0, 0, 0), {}});
  w.runUntil([&] { return w.x(1) > 4.1; }, 1);
  EXPECT_EQ(w.status(1), Status::kBusy);
  w.runUntilIdle(1);
  w.expectAt(1, 7, 0);
  EXPECT_EQ(w.last(Kind::kDone).command, w.last(Kind::kAccepted).command);
}

TEST_F(FollowTest, AnObstacleBeyondTheReleasedEndDoesNotMatter) {
  w.spawn("kiva", "kiva2", 5, 0, kQuarter / 2);  // its corners reach as far as when it turns
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  w.carry(1, 1);
  w.runUntilIdle(1);
  follow(1, alongX(0, 0, 8), 5);
  w.runUntilState(1, State::kWaiting);
  w.expectAt(1, 4, 0);
  EXPECT_EQ(w.count(Kind::kBlocked), 0);
  release(1, 8);
  w.runUntilState(1, State::kBlocked);
  w.expectAt(1, 4, 0);
  release(1, 5);  // it no longer wants there
  w.runUntilState(1, State::kWaiting);
  w.world.remove("kiva2");
  release(1, 8);
  w.runUntilIdle(1);
  w.expectAt(1, 7, 0);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
}

TEST_F(FollowTest, FollowsCloselyWhoLeavesCellByCell) {
  w.spawn("kiva", "kiva2", 1, 0);
  follow(2, alongX(1, 0, 12), 12);
  follow(1, alongX(0, 0, 12), 1);
  std::uint32_t released = 1;
  w.runUntil([&] { return w.status(1) == Status::kIdle; }, 60,
             [&] {
               if (left(2) + 1 > released) release(1, released = left(2) + 1);
             });
  w.expectAt(1, 11, 0);
  EXPECT_EQ(w.count(Kind::kBlocked), 0);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
}

TEST_F(FollowTest, CancelEndsAtTheNextGridPointWhereItCanStop) {
  follow(1, alongX(0, 0, 12), 12);
  w.runUntil([&] { return w.x(1) > 3.5; });
  order(Command::Kind::kCancel, 1);
  w.runUntilIdle(1);
  w.expectAt(1, 5, 0);
  EXPECT_EQ(w.last(Kind::kDone).text, "cancelled");
  EXPECT_EQ(w.last(Kind::kDone).command, w.last(Kind::kAccepted).command);
  order(Command::Kind::kCancel, 1);
  EXPECT_PRED2(contains, w.refusal(), "idle");

  w.mov(1, 9, 4);  // and any other command
  w.runUntil([&] { return w.x(1) > 5.2; });
  order(Command::Kind::kCancel, 1);
  w.runUntilIdle(1);
  w.expectAt(1, 6, 0);
  EXPECT_EQ(w.last(Kind::kDone).text, "cancelled");

  w.spawn("storage_unit", "storage_unit1", 6, 0);
  w.carry(1, 1);
  w.run(0.5);
  order(Command::Kind::kCancel, 1);
  w.runUntilIdle(1);
  EXPECT_EQ(w.loadOf(1), 1);
  EXPECT_EQ(w.last(Kind::kDone).text, "cancelled");

  follow(1, {{6, 0}, {7, 0}}, 1);
  w.world.post(path(1, 9, {{6, 0}, {7, 0}}, 1));
  w.runUntilState(1, State::kWaiting);
  order(Command::Kind::kCancel, 1);
  w.step();
  EXPECT_EQ(w.status(1), Status::kIdle);
}

TEST_F(FollowTest, StopIsFeltAtOnceAndGoesOnAsIfNothingHadBeen) {
  follow(1, alongX(0, 0, 10), 10);
  w.runUntil([&] { return w.speed(1) > 1.499; });
  const double x = w.x(1), speed = w.speed(1);
  order(Command::Kind::kStop, 0);
  w.step();
  EXPECT_NEAR(w.speed(1), speed - 0.0025 / 2, 1e-6);  // its mean in that step
  w.run(0.65);
  EXPECT_LT(w.speed(1), 1e-6);
  EXPECT_NEAR(w.x(1) - x, 1.5 * 1.5 / 5, kMillimetre);
  EXPECT_EQ(w.status(1), Status::kBusy);
  w.run(5);
  EXPECT_EQ(insideOf(w.world).fleet.awake[0], 0);
  release(1, 10);
  order(Command::Kind::kGoOn, 1);
  double top = 0, hardest = 0, before = 0;
  w.runUntil([&] { return w.status(1) == Status::kIdle; }, 30,
             [&] {
               top = std::max(top, w.speed(1));
               hardest = std::max(hardest, std::abs(w.speed(1) - before));
               before = w.speed(1);
             });
  w.expectAt(1, 9, 0);
  EXPECT_NEAR(top, 1.5, 1e-6);
  EXPECT_LT(hardest, 1.2e-3);  // the last step takes up what is left of the way
  EXPECT_EQ(w.count(Kind::kDone), 1);
}

/// v²/2a, however long steps are.
TEST(Stop, TakesItsWayAtAnyStepSize) {
  for (double step : {0.0005, 0.001, 0.004, 0.01}) {
    SCOPED_TRACE("steps of " + number(step) + " s");
    Floorplan plan{60};
    plan.step = step;
    Warehouse w(plan);
    w.spawn("kiva", "kiva1", 0, 0);
    w.movx(1, 20);
    w.runUntil([&] { return w.x(1) > 5; });
    const double x = w.x(1);
    Command stop;
    stop.kind = Command::Kind::kStop;
    stop.kiva_id = 1;
    w.world.post(stop);
    w.run(2);
    EXPECT_NEAR(w.x(1) - x, 1.5 * 1.5 / 5, kMillimetre);
  }
}

TEST_F(FollowTest, StopHoldsTurnsLiftsAndWhatIsCommandedMeanwhile) {
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  w.carry(1, 1);
  w.run(1);
  order(Command::Kind::kStop, 1);
  w.run(0.1);
  const double tower = w.tower(1);
  w.run(3);
  EXPECT_EQ(w.tower(1), tower);
  EXPECT_GT(tower, 0.01);
  order(Command::Kind::kGoOn, 1);
  w.runUntilIdle(1);
  EXPECT_EQ(w.loadOf(1), 1);
  EXPECT_NEAR(w.tower(1), 0.1, 1e-9);

  w.rot(1, kLeft);
  w.runUntil([&] { return w.yaw(1) > 0.5; });
  order(Command::Kind::kStop, 1);
  w.run(1);
  const double yaw = w.yaw(1);
  EXPECT_LT(yaw, 1.5);
  w.run(1);
  EXPECT_NEAR(w.yaw(1), yaw, 1e-9);
  order(Command::Kind::kGoOn, 1);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.yaw(1), kQuarter, kHundredthDegree);

  order(Command::Kind::kStop, 1);
  follow(1, {{0, 0}, {0, 1}, {0, 2}}, 3);
  w.run(2);
  EXPECT_EQ(w.status(1), Status::kBusy);
  w.expectAt(1, 0, 0);
  order(Command::Kind::kGoOn, 1);
  w.runUntilIdle(1);
  w.expectAt(1, 0, 2);
}

TEST_F(FollowTest, CancelledBeforeAnObstacleItDoesNotGoOnBehindIt) {
  w.spawn("person", "person1", 5, 0);
  follow(1, alongX(0, 0, 9), 9);
  w.runUntilState(1, State::kBlocked);
  EXPECT_GT(w.speed(1), 0.5) << "it brakes still";
  order(Command::Kind::kCancel, 1);
  w.step();
  w.world.remove("person1");
  w.runUntilIdle(1);
  w.expectAt(1, 4, 0);
  EXPECT_EQ(w.last(Kind::kDone).text, "cancelled");
}

TEST_F(FollowTest, WhoIsPushedOffItsPathSaysSo) {
  follow(1, alongX(0, 0, 5), 2);
  w.runUntilState(1, State::kWaiting);
  for (int i = 0; i < 300; ++i) {
    w.world.applyWrench("kiva1", "chassis", {0, 4000, 0}, {});
    w.step();
  }
  w.run(1);
  ASSERT_GT(std::abs(w.y(1)), 0.1);
  release(1, 5);
  w.step();
  EXPECT_EQ(w.last(Kind::kBlocked).text, "was pushed off its path");
  EXPECT_EQ(w.status(1), Status::kIdle);
}

TEST(FollowAbruptly, AtInstantaneousSpeedPathsAreFollowedToo) {
  Warehouse w;
  w.spawnText(abruptKiva(), "kiva1", 0, 0);
  w.world.post(path(1, 7, {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}}, 2));
  w.runUntilState(1, State::kWaiting);
  w.expectAt(1, 1, 0);
  w.world.post(path(1, 7, {}, 5));
  w.run(0.5);
  Command stop;
  stop.kind = Command::Kind::kStop;
  w.world.post(stop);
  w.step();
  EXPECT_LT(w.speed(1), 1e-9);
  w.run(1);
  stop.kind = Command::Kind::kGoOn;
  w.world.post(stop);
  w.runUntilIdle(1);
  w.expectAt(1, 2, 2);
}

TEST_F(FollowTest, ACollisionEndsThePath) {
  w.spawnText(withoutPlugin(kivaText(), "laser"), "kiva2", 3, 2, -kQuarter);
  follow(1, alongX(0, 0, 10), 4);
  w.runUntilState(1, State::kWaiting);
  w.movy(2, -4);
  w.runUntil([&] { return w.count(Kind::kCollision) > 0; });
  w.runUntilIdle(1, 5);
  EXPECT_EQ(w.last(Kind::kBlocked).kind, Kind::kBlocked);
  EXPECT_EQ(w.world.fleet().last_end[0], static_cast<int>(Kind::kBlocked));
}

TEST_F(FollowTest, GoesOnFromACheckpointAndRepeatsBitByBit) {
  w.spawn("kiva", "kiva2", 0, 3);
  follow(1, {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}}, 4);
  follow(2, alongX(0, 3, 9), 6);
  w.run(1.7);
  release(2, 7);  // pending
  order(Command::Kind::kStop, 1);
  const std::string bytes = w.world.checkpoint();
  Warehouse other;
  other.world.restore(bytes);
  const auto goOn = [](Warehouse& in) {
    in.run(2);
    Command command;
    command.kind = Command::Kind::kGoOn;
    in.world.post(command);
    in.world.post(path(2, 7, {}, 9));
    in.world.post(path(1, 7, {}, 5));
    in.run(8);
    in.expectAt(1, 2, 2);
    in.expectAt(2, 8, 3);
    return in.world.stateHash();
  };
  EXPECT_EQ(goOn(w), goOn(other));
}

TEST(FollowInBullet, ArraysAndBulletDriveAPathAlike) {
  double x[2], y[2];
  for (bool in_bullet : {false, true}) {
    Floorplan plan;
    plan.options.always_in_bullet = in_bullet;
    Warehouse w(plan);
    w.spawn("kiva", "kiva1", 0, 0);
    w.world.post(path(1, 7, {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {2, 3}}, 5));
    w.run(1);
    w.world.post(path(1, 7, {}, 6));
    w.run(2.9);
    x[in_bullet] = w.x(1);
    y[in_bullet] = w.y(1);
    EXPECT_GT(w.y(1), 0.05);
  }
  EXPECT_NEAR(x[0], x[1], 1e-6);
  EXPECT_NEAR(y[0], y[1], 1e-6);
}

}  // namespace
}  // namespace kiva::test
