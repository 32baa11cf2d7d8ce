// SPDX-License-Identifier: Apache-2.0
//
// The drive models: traction against the jointed reference, and what friction and torque allow.
#include "core/motion/wheels/traction.h"
#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

/// A robot of one drive model, with `load` kg on it if that is positive.
struct DrivenRobot {
  DrivenRobot(const char* drive, double load) {
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
  DrivenRobot traction("traction", GetParam()), jointed("jointed", GetParam());
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
      applyTraction(fleet, 0, {g, {1, 1}}, dt);
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

/// A Kiva that slides with locked wheels, from a speed and at an angle to its heading.
struct Sliding {
  Sliding(double angle, double speed, double yaw) {
    w.spawn("kiva", "kiva1", 0, 0, yaw);
    const Vector3 velocity(speed * std::cos(yaw + angle), speed * std::sin(yaw + angle), 0);
    w.world.setState("kiva1", {Pose(0, 0, 0, 0, 0, yaw), {velocity, {}}});
    w.run(3);
  }
  Warehouse w;
};

TEST(Traction, SidewaysAndAlongShareCoulombsCircle) {
  // Whichever way it slides: mu times the weight on the driven wheels against its motion.
  const double expected = 3. * 3 / (2 * 0.8 * 9.81 * 0.8);
  for (double angle : {0.0, 0.3, kQuarter / 2, 1.2, kQuarter}) {
    const Sliding slid(angle, 3, 0.5);
    EXPECT_NEAR(std::hypot(slid.w.x(1), slid.w.y(1)), expected, 0.005) << angle;
    EXPECT_NEAR(std::atan2(slid.w.y(1), slid.w.x(1)), 0.5 + angle, 0.002) << angle;
    EXPECT_NEAR(slid.w.yaw(1), 0.5, 1e-3) << angle;
  }
}

constexpr double kGravity = 9.81;  // [m/s²]

/// Returns the acceleration [m/s²] of a Kiva of that drive, commanded to 1 m/s², with those Coulomb
/// coefficients.
double speedingUp(const std::string& drive, double tyre, double floor, const char* friction) {
  Warehouse w;
  w.world.remove("ground_plane");
  w.spawnText(
      "<sdf version='1.9'><model name='f'><static>true</static><link name='l'><collision "
      "name='c'><geometry><plane><normal>0 0 1</normal><size>100 100</size></plane>"
      "</geometry><surface><friction><ode><mu>" +
          number(floor) + "</mu><mu2>" + number(floor) +
          "</mu2></ode></friction></surface></collision></link></model></sdf>",
      "ground_plane", 0, 0);
  const std::string mu = number(tyre);
  w.spawnText(
      replaced(kivaText({{"drive", drive}, {"friction", friction}, {"wheel_inertia", "1e-5"}}),
               "<mu>0.8</mu><mu2>0.8</mu2>", "<mu>" + mu + "</mu><mu2>" + mu + "</mu2>"),
      "kiva1", 0, 0);
  w.movx(1, 20);
  w.run(0.4);
  const double before = w.speed(1);
  w.run(0.1);
  return (w.speed(1) - before) / 0.1;
}

TEST(Friction, TheSmallestOfDriveTyreAndFloorDecides) {
  const double mu = 0.02, share = 0.8;
  EXPECT_NEAR(speedingUp("traction", mu, 1, "0.8"), mu * share * kGravity, 1e-4);
  // The jointed robot's rear caster takes m a h / l besides what its springs bear.
  const double centre = (130 * 0.16 + 2 * 2.5 * 0.1 + 10 * 0.38) / 145, casters = 0.30;
  const double jointed = mu * share * kGravity / (1 + mu * centre / casters);
  EXPECT_NEAR(speedingUp("jointed", 0.8, mu, "0.8"), jointed, 0.003 * jointed);
  EXPECT_NEAR(speedingUp("jointed", mu, 1, "0.8"), jointed, 0.003 * jointed);
  // Robots know their wheels and the floor as it was built, and plan with a tenth in reserve.
  EXPECT_NEAR(speedingUp("traction", 0.8, 1, "0.02"), 0.9 * mu * share * kGravity, 1e-4);
  EXPECT_NEAR(speedingUp("traction", 0.8, mu, "0.8"), 0.9 * mu * share * kGravity, 1e-4);
}

// --- a load off the centre

/// A robot with its load's centre of mass at that place, in the chassis frame [m].
Bare cornerLoaded(double x, double y, double torque) {
  DriveParameters drive;
  drive.motor_torque = torque;
  Bare bare(drive);
  Robot& r = bare.fleet.robots[0];
  r.load_mass = 180;
  r.load_centre[0] = x;
  r.load_centre[1] = y;
  r.load_inertia = 180 * (x * x + y * y);
  return bare;
}

TEST(Traction, ALoadToTheLeftYawsARobotWhoseMotorsGiveAllTheyHave) {
  const double y = 0.3, torque = 5;
  Bare bare = cornerLoaded(0, y, torque);
  const Robot& r = bare.fleet.robots[0];
  bare.run(0.001, 100, 100);
  // The wheels push as one through the middle of the axle, the mass is beside it.
  const double mass = 145 + 180, centre = 180 * y / mass;
  const double inertia = r.inertia + r.load_inertia - mass * centre * centre;
  // Both wheels' forces f, from torque - f r = I a_wheel and a_wheel r = a of the floor beneath.
  // Two unknowns, the accelerations ahead of the centre and about z.
  const double m = r.drive.wheel_inertia / std::pow(r.drive.wheel_radius, 2);
  const double left = 0.26 - centre, right = -0.26 - centre;
  // [mass + 2 m, -m (left + right); -m (left + right), inertia + m (left² + right²)]
  const double f = torque / r.drive.wheel_radius;
  const double a = mass + 2 * m, b = -m * (left + right);
  const double d = inertia + m * (left * left + right * right);
  const double p = 2 * f, q = -f * (left + right);
  const double turn = (a * q - b * p) / (a * d - b * b);
  EXPECT_NEAR(bare.fleet.yaw_rate[0], turn * bare.dt, 1e-9);
  EXPECT_GT(turn, 0.05);
}

TEST(Traction, ASlidingRobotWithALoadInItsCornerKeepsItsMomentum) {
  // Without friction its centre of mass goes straight on, however it turns.
  DriveParameters ice;
  ice.friction = 0;
  Bare bare(ice);
  bare.fleet.robots[0].load_mass = 180;
  bare.fleet.robots[0].load_centre[0] = 0.3;
  bare.fleet.robots[0].load_centre[1] = 0.3;
  bare.fleet.robots[0].load_inertia = 180 * 0.18;
  bare.fleet.vx[0] = 1;
  bare.fleet.yaw_rate[0] = 2;
  const double share = 180. / 325, before_x = 0.3 * share, before_y = 0.3 * share;
  const double vx = 1 - 2 * before_y, vy = 2 * before_x;
  bare.run(2, 0, 0);
  const double c = std::cos(bare.fleet.yaw[0]), s = std::sin(bare.fleet.yaw[0]);
  EXPECT_NEAR(bare.fleet.yaw[0], 4, 1e-9);
  EXPECT_NEAR(bare.fleet.x[0] + (c - s) * 0.3 * share, before_x + 2 * vx, 0.002);
  EXPECT_NEAR(bare.fleet.y[0] + (s + c) * 0.3 * share, before_y + 2 * vy, 0.002);
}

/// 180 kg whose centre is towards a corner of the storage unit: half of them lie there.
std::string cornerUnit() {
  return replaced(unitOfMass(180), "<pose>0 0 1.0 0 0 0</pose>",
                  "<pose>0.15 0.15 1.0 0 0 0</pose>");
}

class CornerLoad : public ::testing::TestWithParam<const char*> {};

TEST_P(CornerLoad, IsDrivenAndTurnedAsItAllowsAndStaysOnTheGrid) {
  double took[2];
  for (int corner = 0; corner < 2; ++corner) {
    Warehouse w;
    w.spawnText(kivaText({{"drive", GetParam()}}), "kiva1", 0, 0);
    w.spawnText(corner ? cornerUnit() : unitOfMass(180), "storage_unit1", 0, 0);
    w.carry(1, 1);
    w.runUntilIdle(1);
    double aside = 0;
    w.movx(1, 3);
    w.runUntilIdle(1, 60, [&] { aside = std::max(aside, std::abs(w.y(1))); });
    EXPECT_LT(aside, 0.005);
    w.expectAt(1, 3, 0);
    w.rot(1, kLeft);
    took[corner] = w.runUntilIdle(1);
    w.mov(1, 1, -2);
    w.runUntilIdle(1);
    w.expectAt(1, 1, -2);
    w.expectOnGrid(1);
    EXPECT_EQ(w.count(Event::Kind::kDone), 4);
  }
  EXPECT_GT(took[1], 1.2 * took[0]);
}
INSTANTIATE_TEST_SUITE_P(Drives, CornerLoad, ::testing::Values("traction", "jointed"));

TEST(Jointed, BrakesForAnObstacleNoHarderThanItsLoadAllows) {
  Warehouse w;
  w.spawnText(kivaText({{"drive", "jointed"}}), "kiva1", 0, 0);
  w.spawnText(unitOfMass(450), "storage_unit1", 0, 0);
  w.carry(1, 1);
  w.runUntilIdle(1);
  w.movx(1, 20);
  w.run(4);
  EXPECT_NEAR(w.speed(1), 1.5, 1e-3);
  const double ahead = w.x(1) + 1.6;
  w.spawn("wall", "wall1", ahead, 0, kQuarter);
  w.runUntilIdle(1);
  EXPECT_EQ(w.count(Event::Kind::kCollision), 0);
  EXPECT_EQ(w.count(Event::Kind::kBlocked), 1);
  EXPECT_NEAR(w.x(1), insideOf(w.world).fleet.reference_end[0] + 20, kMillimetre);
}

}  // namespace
}  // namespace kiva::test
