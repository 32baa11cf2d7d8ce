// SPDX-License-Identifier: Apache-2.0
//
// The drive models: traction against the jointed reference, and what friction and torque allow.
#include "core/motion/traction.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

/// A robot of one drive model, with `load` kg on it if that is positive.
struct Journey {
  Journey(const char* drive, double load) {
    w.spawnText(kivaText({{"drive", drive}}), "kiva1", 0, 0);
    if (load > 0) {
      w.spawnText(unitOfMass(load), "storage_unit1", 0, 0);
      w.carry(1, 1);
      w.runUntilIdle(1);
    }
    w.movx(1, 10);
  }
  Warehouse w;
};

class TractionAgainstJointed : public ::testing::TestWithParam<double> {};

TEST_P(TractionAgainstJointed, DifferByLessThanACentimetreAlongTenMetres) {
  Journey traction("traction", GetParam()), jointed("jointed", GetParam());
  double worst = 0;
  traction.w.run(12, [&] {
    jointed.w.step();
    worst = std::max(
        worst, std::hypot(traction.w.x(1) - jointed.w.x(1), traction.w.y(1) - jointed.w.y(1)));
  });
  EXPECT_LT(worst, 0.01);
  EXPECT_GT(worst, 0) << "the same model twice?";
  traction.w.expectAt(1, 10, 0);
  EXPECT_EQ(traction.w.count(Event::Kind::kDone, "kiva1"), GetParam() > 0 ? 2 : 1);
  EXPECT_EQ(jointed.w.count(Event::Kind::kDone, "kiva1"), GetParam() > 0 ? 2 : 1);
}
INSTANTIATE_TEST_SUITE_P(Loads, TractionAgainstJointed, ::testing::Values(0.0, 450.0));

TEST(Jointed, TurnsDrivesAndLiftsAsWell) {
  Warehouse w;
  w.spawnText(kivaText({{"drive", "jointed"}}), "kiva1", 0, 0);
  w.spawn("storage_unit", "storage_unit1", 3, 2);
  w.mov(1, 3, 2);
  w.runUntilIdle(1);
  w.expectAt(1, 3, 2);
  w.carry(1, 1);
  w.runUntilIdle(1);
  EXPECT_EQ(w.loadOf(1), 1);
  w.mov(1, 0, 0);
  w.runUntilIdle(1);
  w.expectAt(1, 0, 0);
  EXPECT_EQ(w.count(Event::Kind::kDone), 3);
}

/// One robot's drive alone, without commands: what the wheels do to it.
struct Bare {
  explicit Bare(const DriveParameters& drive) {
    Robot robot;
    robot.id = 1;
    robot.drive = drive;
    fleet.add(robot, 0, 0, 0);
  }
  void run(double seconds, double left, double right) {
    fleet.wheel_target[0][0] = left;
    fleet.wheel_target[1][0] = right;
    for (int i = 0; i < std::lround(seconds / dt); ++i) {
      applyTraction(fleet, 0, g, dt);
      integrate(fleet, 0, dt);
    }
  }
  double wheel(int side) const { return fleet.wheel_speed[side][0]; }
  FleetState fleet;
  const double g = 9.81, dt = 0.001;
};

TEST(Traction, AcceleratesWithWhatTheMotorsGive) {
  DriveParameters weak;
  weak.motor_torque = 5;  // [Nm], far below what the floor holds
  Bare bare(weak);
  bare.run(1, 100, 100);
  const Robot& r = bare.fleet.robots[0];
  // Both motors' force on the mass and the spinning wheels: F = m a + 2 I a / r².
  const double force = 2 * weak.motor_torque / weak.wheel_radius;
  const double mass = r.mass + 2 * weak.wheel_inertia / std::pow(weak.wheel_radius, 2);
  EXPECT_NEAR(bare.fleet.vx[0], force / mass, 1e-6);
  EXPECT_NEAR(bare.wheel(0) * weak.wheel_radius, bare.fleet.vx[0], 1e-9);  // it rolls
}

TEST(Traction, SlipsWhereTheFloorHoldsLess) {
  DriveParameters ice;
  ice.friction = 0.05;
  Bare bare(ice);
  bare.run(1, 100, 100);
  // Coulomb: mu times the weight on the driven wheels, over the mass.
  EXPECT_NEAR(bare.fleet.vx[0], ice.friction * bare.g * ice.drive_wheel_load, 1e-6);
  EXPECT_GT(bare.wheel(0) * ice.wheel_radius, 2 * bare.fleet.vx[0]);
}

TEST(Traction, ALoadMakesItSlower) {
  DriveParameters weak;
  weak.motor_torque = 5;
  Bare empty(weak), loaded(weak);
  loaded.fleet.robots[0].load_mass = 450;
  empty.run(1, 100, 100);
  loaded.run(1, 100, 100);
  EXPECT_NEAR(empty.fleet.vx[0] / loaded.fleet.vx[0], (145 + 6 + 450) / (145.0 + 6), 0.01);
}

TEST(Traction, LockedWheelsStopASlidingRobotByFriction) {
  Bare bare(DriveParameters{});
  bare.fleet.vy[0] = 1;  // sideways: only friction can
  bare.run(0.1, 0, 0);
  EXPECT_NEAR(bare.fleet.vy[0], 1 - 0.8 * 9.81 * 0.8 * 0.1, 1e-6);
  bare.run(1, 0, 0);
  EXPECT_EQ(bare.fleet.vy[0], 0);
}

}  // namespace
}  // namespace kiva::test
