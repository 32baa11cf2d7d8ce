// SPDX-License-Identifier: Apache-2.0
//
// Moves along the grid: ends, durations, speeds and reports.
#include <numeric>
#include <random>

#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr double kSlack =
    0.03;  // [s]: a segment's start and its coming to rest, beyond its profile

/// Returns the time from rest to rest over `distance` [s].
double trapezoidTime(double distance, double speed, double acceleration) {
  if (acceleration == 0) return distance / speed;
  const bool reaches_top = distance * acceleration >= speed * speed;
  return reaches_top ? distance / speed + speed / acceleration
                     : 2 * std::sqrt(distance / acceleration);
}

struct MoveCase {
  double acceleration;  // [m/s²]
  double load;          // [kg]
};

class MoveOfAnyLength : public ::testing::TestWithParam<MoveCase> {
 protected:
  void SetUp() override {
    w_.spawnText(kivaText({{"acceleration", number(GetParam().acceleration)}}), "kiva1", 0, 0);
    if (GetParam().load == 0) return;
    w_.spawnText(unitOfMass(GetParam().load), "storage_unit1", 0, 0);
    w_.carry(1, 1);
    w_.runUntilIdle(1);
    ASSERT_EQ(w_.loadOf(1), 1);
  }

  static std::vector<int> lengths() {
    if (GetParam().load > 0) return {1, 2, 3, 5, 8, 13, 21, 30};
    std::vector<int> all(30);
    std::iota(all.begin(), all.end(), 1);
    return all;
  }

  /// Moves along an axis (0 = x, 1 = y). Returns the duration [s], without that of turning.
  double move(int axis, double distance) {
    axis == 0 ? w_.movx(1, distance) : w_.movy(1, distance);
    w_.runUntilState(1, axis == 0 ? State::kMovingX : State::kMovingY);
    return w_.runUntilIdle(1);
  }

  Warehouse w_;
};

TEST_P(MoveOfAnyLength, StopsOnItsGridPointAfterTheTrapezoidsTime) {
  for (int axis : {0, 1}) {
    for (int cells : lengths()) {
      for (int way : {cells, -cells}) {
        const double took = move(axis, way);
        const double end = way > 0 ? way : 0;
        w_.expectAt(1, axis == 0 ? end : 0, axis == 1 ? end : 0);
        w_.expectOnGrid(1);
        const double expected = trapezoidTime(cells, 1.5, GetParam().acceleration);
        EXPECT_NEAR(took, expected, kSlack) << way << " m along "
                                            << "xy"[axis];
      }
    }
  }
  EXPECT_EQ(w_.count(Event::Kind::kRefused), 0);
  EXPECT_EQ(w_.count(Event::Kind::kBlocked), 0);
}

INSTANTIATE_TEST_SUITE_P(Loads, MoveOfAnyLength,
                         ::testing::Values(MoveCase{1, 0}, MoveCase{1, 450}, MoveCase{0, 0},
                                           MoveCase{0, 450}),
                         [](const auto& info) {
                           return "Acceleration" + number(info.param.acceleration) + "Load" +
                                  number(info.param.load);
                         });

TEST(Motion, IsAsExactWithOtherStepSizes) {
  for (double step : {0.0005, 0.002, 0.005, 0.01}) {
    Floorplan plan;
    plan.step = step;
    Warehouse w(plan);
    w.spawn("kiva", "kiva1", 0, 0);
    for (const auto& [x, y] : {std::pair{7, 3}, {-2, 4}, {0, 0}}) {
      w.mov(1, x, y);
      w.runUntilIdle(1);
      w.expectAt(1, x, y);
      w.expectOnGrid(1);
    }
    EXPECT_EQ(w.count(Event::Kind::kDone), 3) << step;
  }
}

TEST(Motion, WheelsThatSlipALittleArriveAllTheSame) {
  Warehouse w;  // the floor holds 5 m/s² and not 20
  w.spawnText(kivaText({{"acceleration", "20"}}), "kiva1", 0, 0);
  w.movx(1, 10);
  w.runUntilIdle(1);
  w.expectAt(1, 10, 0);
  EXPECT_EQ(w.count(Event::Kind::kDone), 1);
}

TEST(Motion, AMoveByNothingIsDoneAtOnce) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 3, -2);
  w.forget();
  w.mov(1, 3, -2);
  w.movx(1, 0);
  w.movy(1, 0);
  w.step();
  using Kind = Event::Kind;
  EXPECT_EQ(w.kindsOf("kiva1"), (std::vector<Kind>{Kind::kAccepted, Kind::kDone, Kind::kAccepted,
                                                   Kind::kDone, Kind::kAccepted, Kind::kDone}));
  EXPECT_EQ(w.status(1), Status::kIdle);
  EXPECT_TRUE(w.changes.empty());
}

TEST(Motion, MovGoesAlongXThenAlongYTurningAsNeeded) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0, kQuarter);
  w.forget();
  w.mov(1, 3, -2);
  w.runUntilIdle(1, 60, [&] {
    if (w.state(1) == State::kMovingX) {
      EXPECT_NEAR(w.y(1), 0, kMillimetre);
    }
    if (w.state(1) == State::kMovingY) {
      EXPECT_NEAR(w.x(1), 3, kMillimetre);
    }
  });
  w.expectAt(1, 3, -2);
  EXPECT_EQ(w.statesOf(1), (std::vector<State>{State::kRotating, State::kMovingX, State::kRotating,
                                               State::kMovingY, State::kIdle}));
}

TEST(Motion, ARobotThatFacesItsWayDoesNotTurn) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0, M_PI);
  w.forget();
  w.movx(1, -4);
  w.runUntilIdle(1);
  EXPECT_EQ(w.statesOf(1), (std::vector<State>{State::kMovingX, State::kIdle}));
  w.expectAt(1, -4, 0);
}

TEST(Motion, EveryStatusChangeTellsWhereTheRobotIs) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.forget();
  w.mov(1, 2, 1);
  w.runUntilIdle(1);
  ASSERT_EQ(w.changes.size(), 4u);  // MOVING_X, ROTATING, MOVING_Y, IDLE
  EXPECT_NEAR(w.changes[1].x, 2, kMillimetre);
  EXPECT_NEAR(w.changes[1].yaw, 0, kHundredthDegree);
  EXPECT_NEAR(w.changes[2].yaw, kQuarter, kHundredthDegree);
  EXPECT_NEAR(w.changes[3].y, 1, kMillimetre);
  EXPECT_EQ(w.changes[0].status, Status::kBusy);
  EXPECT_EQ(w.changes[3].status, Status::kIdle);
  EXPECT_NEAR(w.changes[3].time, w.world.time(), 2 * w.world.stepSize());
}

/// Largest values of a robot on its way over 20 m.
struct Peaks {
  double speed = 0;         // [m/s]
  double acceleration = 0;  // [m/s²], over 10 ms
};

Peaks peaks(double speed, double acceleration) {
  Warehouse w;
  w.spawnText(kivaText({{"speed", number(speed)}, {"acceleration", number(acceleration)}}), "kiva1",
              0, 0);
  Peaks peaks;
  std::vector<double> speeds{0};
  w.movx(1, 20);
  w.runUntilIdle(1, 60, [&] {
    speeds.push_back(w.speed(1));
    peaks.speed = std::max(peaks.speed, speeds.back());
    if (speeds.size() <= 10) return;
    const double change = speeds.back() - speeds[speeds.size() - 11];
    peaks.acceleration = std::max(peaks.acceleration, std::abs(change) / (10 * w.world.stepSize()));
  });
  return peaks;
}

TEST(Motion, HoldsItsSpeedAndItsAcceleration) {
  for (double speed : {0.5, 1.5, 3.0}) {
    for (double acceleration : {0.5, 1.0, 2.0}) {
      const Peaks measured = peaks(speed, acceleration);
      EXPECT_LE(measured.speed, speed * 1.001);
      EXPECT_GE(measured.speed, speed * 0.999);  // 20 m are enough to get there
      EXPECT_LE(measured.acceleration, acceleration * 1.02);
    }
  }
}

TEST(Motion, WithoutAccelerationTheSpeedIsThereAtOnce) {
  Warehouse w;
  w.spawnText(abruptKiva(), "kiva1", 0, 0);
  w.movx(1, 3);
  w.run(0.005);
  EXPECT_NEAR(w.speed(1), 1.5, 1e-6);
}

TEST(Motion, TheWheelsRollAsFarAsTheRobotGoes) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.movx(1, 10);
  w.runUntilIdle(1);
  for (int wheel : {0, 1}) {
    EXPECT_NEAR(w.world.fleet().wheel_angle[wheel][w.index(1)] * 0.1, 10, 0.01);
  }
}

TEST(Motion, TheRobotKeepsToItsLine) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.movx(1, 30);
  double farthest = 0;
  w.runUntilIdle(1, 60, [&] { farthest = std::max(farthest, std::abs(w.y(1))); });
  EXPECT_LT(farthest, kMillimetre);
}

/// One random command that keeps within ±5 m.
void postRandom(Warehouse& w, std::mt19937& random) {
  const auto cells = [&](double from, double to) {
    return std::round(std::uniform_real_distribution<double>(from, to)(random));
  };
  switch (random() % 4) {
    case 0:
      return w.mov(1, cells(-5, 5), cells(-5, 5));
    case 1:
      return w.movx(1, cells(-5, 5) - std::round(w.x(1)));
    case 2:
      return w.movy(1, cells(-5, 5) - std::round(w.y(1)));
    default:
      return w.rot(1, random() % 2 ? kLeft : kRight);
  }
}

TEST(Motion, AThousandRandomCommandsLeaveTheRobotOnTheGrid) {
  for (const char* acceleration : {"1", "0"}) {
    Warehouse w;
    w.spawnText(kivaText({{"acceleration", acceleration}}), "kiva1", 0, 0);
    std::mt19937 random(7);
    for (int i = 0; i < 1000 && !::testing::Test::HasFailure(); ++i) {
      postRandom(w, random);
      w.runUntilIdle(1);
      w.expectOnGrid(1);
    }
    EXPECT_EQ(w.count(Event::Kind::kAccepted), 1000);
    EXPECT_EQ(w.count(Event::Kind::kDone), 1000);
  }
}

TEST(Motion, ARobotPushedOffTheGridReturnsToItBeforeItsCommand) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.world.setState("kiva1", {Pose(2.3, 0.2, 0, 0, 0, 0.4), {}});
  w.movx(1, 3);
  w.runUntilIdle(1);
  w.expectAt(1, 5, 0);
  w.expectOnGrid(1);
  EXPECT_EQ(w.count(Event::Kind::kDone), 1);
}

TEST(Motion, ARobotTurnedOffTheGridTurnsBackBeforeItsCommand) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.world.setState("kiva1", {Pose(0, 0, 0, 0, 0, 0.3), {}});
  w.movx(1, 0);
  w.runUntilIdle(1);
  w.expectAt(1, 0, 0);
  w.expectOnGrid(1);
}

TEST(Motion, TheSameCommandsGiveTheSameTrajectory) {
  const auto drive = [] {
    Warehouse w;
    w.spawn("kiva", "kiva1", 0, 0);
    std::vector<double> path;
    w.mov(1, 3, 4);
    w.runUntilIdle(1, 60, [&] { path.push_back(w.x(1) + 1000 * w.y(1)); });
    return path;
  };
  EXPECT_EQ(drive(), drive());
}

}  // namespace
}  // namespace kiva::test
