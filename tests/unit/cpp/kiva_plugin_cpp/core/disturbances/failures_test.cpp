// SPDX-License-Identifier: Apache-2.0
//
// Abilities of a robot with a failure, and its recovery after the repair.
#include <cmath>

#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;

class Failures : public ::testing::Test {
 protected:
  Failures() {
    w.spawn("kiva", "kiva1", 0, 0);
    w.forget();
  }

  int failures() const { return w.world.fleet().failures[0]; }

  Warehouse w{Floorplan{40}};
};

TEST_F(Failures, OfTheDriveBrakeTheRobotWhichGoesOnAfterwards) {
  w.movx(1, 10);
  w.run(3);
  ASSERT_NEAR(w.speed(1), 1.5, 1e-6);
  const double here = w.x(1);
  w.world.fail(1, Failure::kMotor, 5);
  w.run(2);
  EXPECT_EQ(w.speed(1), 0);
  // As hard as it brakes in an emergency: 1.5² / (2 · 2.5) m.
  EXPECT_NEAR(w.x(1) - here, 0.45, 0.02);
  EXPECT_EQ(failures(), bitOf(Failure::kMotor));
  w.runUntilIdle(1);
  EXPECT_NEAR(w.x(1), 10, kMillimetre);
  EXPECT_EQ(failures(), 0);
  EXPECT_EQ(w.count(Kind::kFailed), 1);
  EXPECT_EQ(w.count(Kind::kRepaired), 1);
  EXPECT_NEAR(w.last(Kind::kRepaired).time - w.last(Kind::kFailed).time, 5, 0.002);
  EXPECT_EQ(w.count(Kind::kDone), 1);
}

TEST_F(Failures, LeaveATurningRobotStandingBetweenTwoHeadings) {
  w.rot(1, kLeft);
  w.run(0.3);
  w.world.fail(1, Failure::kMotor, 0);
  w.run(2);
  EXPECT_GT(w.yaw(1), 0.1);
  EXPECT_LT(w.yaw(1), kQuarter - 0.1);
  w.world.repair(1);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.yaw(1), kQuarter, kHundredthDegree);
}

TEST_F(Failures, OfTheLiftHoldTheTowerButLetTheRobotDrive) {
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  w.carry(1, 1);
  w.run(1);
  w.world.fail(1, Failure::kLift, 4);
  w.run(0.5);
  const double height = w.world.fleet().tower[0];
  EXPECT_GT(height, 0);
  w.run(2);
  EXPECT_EQ(w.world.fleet().tower[0], height);
  w.runUntilIdle(1);
  EXPECT_EQ(w.count(Kind::kLifted), 1);
  w.world.fail(1, Failure::kLift, 0);
  w.movx(1, 1);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.x(1), 1, kMillimetre);
}

TEST_F(Failures, OfTheLaserLeaveNoScansAndStopTheRobot) {
  w.movx(1, 10);
  w.run(3);
  w.world.fail(1, Failure::kLaser, 3);
  std::vector<float> ranges;
  w.world.scan(0, &ranges);
  for (float range : ranges) EXPECT_TRUE(std::isnan(range));
  for (int i = 0; i < 1000; ++i) {
    w.step();
    EXPECT_TRUE(w.world.scansDue().empty());
  }
  EXPECT_EQ(w.speed(1), 0);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.x(1), 10, kMillimetre);
  w.world.scan(0, &ranges);
  EXPECT_TRUE(std::isinf(ranges[0]));
}

TEST_F(Failures, OfTheRadioMakeItDeafAndDumbButItDoesWhatItWasTold) {
  w.movx(1, 3);
  w.run(1);
  const double here = w.x(1);
  w.world.fail(1, Failure::kRadio, 0);
  w.changes.clear();
  w.movx(1, 1);
  w.step();
  EXPECT_PRED2(contains, w.last(Kind::kRefused).text, "it hears nothing");
  w.run(5);
  EXPECT_NEAR(w.x(1), 3, kMillimetre);
  EXPECT_TRUE(w.changes.empty());
  const auto last = w.world.lastHeard(0);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->x, here);
  EXPECT_EQ(last->status, Status::kBusy);
  Command stop;
  stop.kind = Command::Kind::kStop;
  w.world.post(stop);  // of all
  w.step();
  EXPECT_EQ(w.world.fleet().stopped[0], 0);
  w.world.repair(1);
  w.step();
  EXPECT_FALSE(w.world.lastHeard(0));
  ASSERT_FALSE(w.changes.empty());
  EXPECT_EQ(w.changes.back().status, Status::kIdle);
}

TEST_F(Failures, OfTheRadioDoNotHideItFromWhoeverMovesIt) {
  w.movx(1, 3);
  w.run(1);
  w.world.fail(1, Failure::kRadio, 0);
  w.world.setState("kiva1", {Pose(0, 7, 0, 0, 0, 0), {}});
  const auto last = w.world.lastHeard(0);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->y, 7);
  EXPECT_EQ(last->status, Status::kIdle);
}

TEST_F(Failures, OfTheWheelsMakeItTurnSlowlyAndArriveAllTheSame) {
  const auto time = [&] {
    const double before = w.world.time();
    w.rot(1, kLeft);
    w.runUntilIdle(1);
    return w.world.time() - before;
  };
  const double sound = time();
  w.movx(1, 10);
  w.run(3);
  w.world.fail(1, Failure::kWheelSlip, 0);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.x(1), 10, kMillimetre);
  EXPECT_GT(time(), 1.2 * sound);
  w.rot(1, kLeft);
  w.run(0.2);
  w.world.repair(1);
  w.runUntilIdle(1);
  EXPECT_EQ(w.count(Kind::kBlocked), 0);
  EXPECT_NEAR(time(), sound, 0.01);
}

TEST_F(Failures, StayWithTheRobotInACheckpoint) {
  w.movx(1, 10);
  w.run(3);
  w.world.fail(1, Failure::kMotor, 5);
  w.world.fail(1, Failure::kWheelSlip, 0);
  w.world.fail(1, Failure::kRadio, 7);
  w.run(1);
  Warehouse other{Floorplan{1}};
  other.world.restore(w.world.checkpoint());
  EXPECT_EQ(other.world.stateHash(), w.world.stateHash());
  EXPECT_EQ(other.world.fleet().failures[0], failures());
  for (int i = 0; i < 10000; ++i) {
    w.step();
    other.step();
  }
  EXPECT_EQ(other.world.stateHash(), w.world.stateHash());
  EXPECT_NEAR(other.x(1), 10, kMillimetre);
}

TEST_F(Failures, EndWithAReset) {
  w.world.fail(1, Failure::kMotor, 0);
  w.world.reset(true);
  w.movx(1, 1);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.x(1), 1, kMillimetre);
}

TEST_F(Failures, GoWithTheirRobot) {
  w.spawn("kiva", "kiva2", 0, 5);
  w.world.fail(1, Failure::kMotor, 1);
  w.world.remove("kiva1");
  w.run(2);
  EXPECT_EQ(w.world.fleet().failures[0], 0);
  EXPECT_EQ(w.count(Kind::kRepaired), 0);
}

TEST_F(Failures, OfWhatIsNotThereAreErrors) {
  EXPECT_THROW(w.world.fail(7, Failure::kMotor, 0), std::invalid_argument);
  EXPECT_THROW(w.world.fail(1, Failure::kMotor, -1), std::invalid_argument);
  EXPECT_THROW(w.world.fail(1, static_cast<Failure>(9), 0), std::invalid_argument);
  EXPECT_THROW(w.world.repair(7), std::invalid_argument);
  EXPECT_EQ(w.count(Kind::kFailed), 0);
}

}  // namespace
}  // namespace kiva::test
