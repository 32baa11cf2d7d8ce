// SPDX-License-Identifier: Apache-2.0
#include "core/motion/traction.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kiva {
namespace {

constexpr double kRestSpeed = 1e-9;  // [m/s, rad/s]: below, a braked robot stands
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// The chassis with its load in its own frame, and its wheels.
struct Vehicle {
  double mass, inertia;     // [kg], [kg m²] about z, wheels excluded from spinning
  double radius, half_gap;  // wheel radius, half the wheel separation [m]
  double wheel_inertia;     // [kg m²]
  double torque;            // limit of one motor [Nm]
  double grip;              // limit of one wheel's friction force [N]
};

Vehicle vehicle(const Robot& robot, double gravity) {
  const DriveParameters& drive = robot.drive;
  const double mass = robot.mass + robot.load_mass;
  const bool ideal = drive.acceleration == 0;
  return {mass,
          robot.inertia + robot.load_inertia,
          drive.wheel_radius,
          drive.wheel_separation / 2,
          drive.wheel_inertia,
          ideal ? kUnlimited : drive.motor_torque,
          ideal ? kUnlimited : drive.friction * mass * gravity * drive.drive_wheel_load / 2};
}

/// One wheel within a step. A motor holds its wheel at the target as long as its torque suffices;
/// then it gives what it has, and the wheel's speed is found with the floor's.
struct Wheel {
  double speed = 0;        // at the beginning of the step [rad/s]
  double target = 0;       // [rad/s]
  bool saturated = false;  // the motor is at its limit
  double motor = 0;        // impulse of a saturated motor [Nm s]
  double floor_speed = 0;  // of the chassis over the floor at this wheel [m/s]
  double friction = 0;     // impulse of the floor on the wheel, forward [N s]
};

double slipWithoutFriction(const Vehicle& v, const Wheel& wheel) {
  const double spin = wheel.saturated ? wheel.speed + wheel.motor / v.wheel_inertia : wheel.target;
  return wheel.floor_speed - v.radius * spin;
}

/// Friction impulses that end the slip of both wheels within the step, each at most `limit`
/// (Coulomb): a linear complementarity problem of two unknowns, solved by cases. A saturated
/// wheel's own inertia takes part; that of one held by its motor does not.
void solveFriction(const Vehicle& v, double limit, Wheel wheels[2]) {
  const double turn = v.half_gap * v.half_gap / v.inertia;
  const double coupled = 1 / v.mass - turn;
  double own[2], slip[2];
  for (int i = 0; i < 2; ++i) {
    own[i] = 1 / v.mass + turn + (wheels[i].saturated ? v.radius * v.radius / v.wheel_inertia : 0);
    slip[i] = slipWithoutFriction(v, wheels[i]);
  }
  const double determinant = own[0] * own[1] - coupled * coupled;
  for (int i = 0; i < 2; ++i) {
    wheels[i].friction = (-own[1 - i] * slip[i] + coupled * slip[1 - i]) / determinant;
  }
  for (int i = 0; i < 2; ++i) {
    if (std::abs(wheels[i].friction) <= limit) continue;
    wheels[i].friction = std::copysign(limit, wheels[i].friction);
    Wheel& rest = wheels[1 - i];  // is solved for again
    rest.friction =
        std::clamp(-(slip[1 - i] + coupled * wheels[i].friction) / own[1 - i], -limit, limit);
    return;
  }
}

/// Impulse that the motor needs to have the wheel at its target after the step [Nm s].
double neededMotor(const Vehicle& v, const Wheel& wheel) {
  return v.wheel_inertia * (wheel.target - wheel.speed) + v.radius * wheel.friction;
}

/// Finds which motors are at their limits, and the floor's friction with it.
void solveWheels(const Vehicle& v, double friction_limit, double motor_limit, Wheel wheels[2]) {
  for (int round = 0; round < 3; ++round) {
    solveFriction(v, friction_limit, wheels);
    bool changed = false;
    for (int i = 0; i < 2; ++i) {
      const double needed = neededMotor(v, wheels[i]);
      if (wheels[i].saturated || std::abs(needed) <= motor_limit) continue;
      wheels[i].saturated = changed = true;
      wheels[i].motor = std::copysign(motor_limit, needed);
    }
    if (!changed) return;
  }
}

double speedAfter(const Vehicle& v, const Wheel& wheel) {
  if (!wheel.saturated) return wheel.target;
  return wheel.speed + (wheel.motor - v.radius * wheel.friction) / v.wheel_inertia;
}

}  // namespace

void applyTraction(FleetState& fleet, int i, double gravity, double dt) {
  const Vehicle v = vehicle(fleet.robots[i], gravity);
  const double c = std::cos(fleet.yaw[i]), s = std::sin(fleet.yaw[i]);
  double forward = c * fleet.vx[i] + s * fleet.vy[i];
  double sideways = -s * fleet.vx[i] + c * fleet.vy[i];
  double turn = fleet.yaw_rate[i];
  // Sideways both wheels grip the floor as one: they share the axle.
  const double grip = v.grip * dt;
  const double hold = std::clamp(-v.mass * sideways, -2 * grip, 2 * grip);
  sideways += hold / v.mass;
  // Coulomb's circle: what holds sideways is not there to drive.
  const double limit =
      grip == kUnlimited ? kUnlimited : std::sqrt(std::max(0.0, grip * grip - hold * hold / 4));

  Wheel wheels[2];
  for (int side = 0; side < 2; ++side) {
    wheels[side].speed = fleet.wheel_speed[side][i];
    wheels[side].target = fleet.wheel_target[side][i];
    wheels[side].floor_speed = forward + (side == 0 ? -1 : 1) * turn * v.half_gap;
  }
  solveWheels(v, limit, v.torque * dt, wheels);
  forward += (wheels[0].friction + wheels[1].friction) / v.mass;
  turn += (wheels[1].friction - wheels[0].friction) * v.half_gap / v.inertia;

  for (int side = 0; side < 2; ++side) {
    fleet.wheel_speed[side][i] = speedAfter(v, wheels[side]);
  }
  fleet.vx[i] = c * forward - s * sideways;
  fleet.vy[i] = s * forward + c * sideways;
  fleet.yaw_rate[i] = turn;
}

void integrate(Fleet& fleet, int i, double dt) {
  fleet.x[i] += fleet.vx[i] * dt;
  fleet.y[i] += fleet.vy[i] * dt;
  fleet.yaw[i] += fleet.yaw_rate[i] * dt;
  for (int wheel = 0; wheel < 2; ++wheel) {
    fleet.wheel_angle[wheel][i] += fleet.wheel_speed[wheel][i] * dt;
  }
}

double drivingLimit(const Robot& robot, double gravity) {
  const Vehicle v = vehicle(robot, gravity);
  const double force = std::min(v.torque / v.radius, v.grip);
  return 2 * force / (v.mass + 2 * v.wheel_inertia / (v.radius * v.radius));
}

double turningLimit(const Robot& robot, double gravity) {
  const Vehicle v = vehicle(robot, gravity);
  const double force = std::min(v.torque / v.radius, v.grip);
  const double spin = v.wheel_inertia * v.half_gap / (v.radius * v.radius);
  return 2 * force * v.half_gap / (v.inertia + 2 * spin * v.half_gap);
}

bool atRest(const FleetState& fleet, int i) {
  return std::abs(fleet.vx[i]) < kRestSpeed && std::abs(fleet.vy[i]) < kRestSpeed &&
         std::abs(fleet.yaw_rate[i]) < kRestSpeed && fleet.wheel_target[0][i] == 0 &&
         fleet.wheel_target[1][i] == 0;
}

}  // namespace kiva
