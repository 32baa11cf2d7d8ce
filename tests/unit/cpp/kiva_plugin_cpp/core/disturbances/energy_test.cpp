// SPDX-License-Identifier: Apache-2.0
//
// Consumption of batteries, and charging.
#include <cmath>

#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;

constexpr double kHour = 3600;  // [s], and joules in a watt hour

/// A robot with a battery of 10 Wh that begins full; a place to charge at 3, 0.
class Energy : public ::testing::Test {
 protected:
  static Floorplan planOf(const std::function<void(EnergyRealism&)>& change) {
    Floorplan plan{40};
    plan.options.realism.emplace();
    EnergyRealism& energy = plan.options.realism->energy;
    energy.enabled = true;
    energy.capacity = 10;
    energy.initial_least = 1;
    change(energy);
    return plan;
  }
  explicit Energy(const std::function<void(EnergyRealism&)>& change = [](EnergyRealism&) {})
      : w(planOf(change)) {
    w.spawnText(
        "<sdf version='1.9'><model name='m'><static>true</static><link name='charging'><visual "
        "name='0'><pose>3 0 0 0 0 0</pose><geometry><box><size>0.9 0.9 0.01</size></box>"
        "</geometry></visual></link></model></sdf>",
        "floor_markings1", 0, 0);
    w.spawn("kiva", "kiva1", 0, 0);
    w.forget();
  }
  /// Runs until batteries have been read, which happens ten times a second.
  void read() {
    w.runUntil([this] { return w.world.steps() % 100 == 1; });
  }
  double joules() const { return w.world.fleet().charge[0] * 10 * kHour; }

  Warehouse w;
};

TEST_F(Energy, GoesToElectronicsAlsoOfARobotThatStands) {
  w.run(100);
  EXPECT_NEAR(10 * kHour - joules(), 80 * 100, 10);
}

/// Returns the energy of both wheels with their motors at that speed of their rims [J].
double spinning(const Robot& robot, double speed) {
  const double rate = speed / robot.drive.wheel_radius;
  return robot.drive.wheel_inertia * rate * rate;
}

TEST_F(Energy, OfADriveIsThatOfItsMotionAndOfRolling) {
  read();
  const double before = joules(), began = w.world.time();
  w.movx(1, 10);
  w.runUntilIdle(1);
  read();
  const double mass = w.robot(1).mass;
  const double motion = mass * 1.5 * 1.5 / 2 + spinning(w.robot(1), 1.5);
  const double rolling = 0.015 * mass * 9.81 * 10;
  const double expected = motion / 0.75 - 0.3 * motion + rolling / 0.75;
  EXPECT_NEAR(before - joules(), expected + 80 * (w.world.time() - began), 0.003 * expected);
}

/// Half of it speeds up at 4 · 90° / T², to 180° / T; its wheels roll on a circle.
TEST_F(Energy, OfATurnIsThatOfItsMotionAndOfRolling) {
  read();
  const double before = joules(), began = w.world.time();
  w.rot(1, kLeft);
  w.runUntilIdle(1);
  read();
  const Robot& robot = w.robot(1);
  const double top = M_PI / robot.drive.quarter_turn_time;
  const double arm = robot.drive.wheel_separation / 2;
  const double motion = robot.inertia * top * top / 2 + spinning(robot, top * arm);
  const double rolled = arm * kQuarter;
  const double rolling = 0.015 * robot.mass * 9.81 * rolled;
  const double expected = motion / 0.75 - 0.3 * motion + rolling / 0.75;
  EXPECT_NEAR(before - joules(), expected + 80 * (w.world.time() - began), 0.003 * expected);
}

TEST_F(Energy, OfALiftIsThatOfItsLoad) {
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  read();
  const double before = joules(), began = w.world.time();
  w.carry(1, 1);
  w.runUntilIdle(1);
  read();
  const double used = before - joules() - 80 * (w.world.time() - began);
  const double lifted = w.unit(1).mass * 9.81 * w.unitPose(1).Pos().Z();
  EXPECT_NEAR(used, lifted / 0.4, 0.01 * used);
}

TEST_F(Energy, ComesBackWhereChargingIsPainted) {
  w.movx(1, 3);
  w.runUntilIdle(1);
  w.run(60);
  EXPECT_GT(w.world.fleet().charge[0], 0.97F);
  w.movx(1, 1);
  w.runUntilIdle(1);
  const double before = joules();
  w.run(10);
  EXPECT_LT(joules(), before);
}

class LittleEnergy : public Energy {
 protected:
  LittleEnergy() : Energy([](EnergyRealism& e) { e.initial_least = e.initial_most = 0.02; }) {}
};

TEST_F(LittleEnergy, LetsARobotStandUntilItHasAFullBattery) {
  w.movx(1, 15);
  w.run(30);
  EXPECT_EQ(w.count(Kind::kFailed), 1);
  EXPECT_PRED2(contains, w.last(Kind::kFailed).text, "battery is empty");
  EXPECT_EQ(w.world.fleet().failures[0], kEmptyBattery);
  EXPECT_EQ(w.speed(1), 0);
  EXPECT_LT(w.x(1), 14);
  w.world.repair(1);
  w.runUntilIdle(1);
  w.expectAt(1, 15, 0);
  EXPECT_EQ(w.count(Kind::kRepaired), 1);
}

TEST_F(LittleEnergy, IsInACheckpoint) {
  w.movx(1, 15);
  w.run(5);
  Warehouse other{Floorplan{1}};
  other.world.restore(w.world.checkpoint());
  EXPECT_EQ(other.world.fleet().charge[0], w.world.fleet().charge[0]);
  w.run(20);
  other.run(20);
  EXPECT_EQ(other.world.stateHash(), w.world.stateHash());
  EXPECT_EQ(other.world.fleet().failures[0], kEmptyBattery);
}

}  // namespace
}  // namespace kiva::test
