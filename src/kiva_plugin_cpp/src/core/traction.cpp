// SPDX-License-Identifier: Apache-2.0
#include "traction.h"

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

/// Motor torques [Nm] that bring rolling wheels to their targets within the step, if the limits
/// allow. Rolling without slip couples the wheels through the chassis:
/// torque = [[a, c], [c, a]] · wheel acceleration.
void motorTorques(const Vehicle& v, const double speed[2], const double target[2], double dt,
                  double torque[2]) {
  const double r2 = v.radius * v.radius;
  const double turn = v.inertia / (4 * v.half_gap * v.half_gap);
  const double a = v.wheel_inertia + r2 * (v.mass / 4 + turn);
  const double c = r2 * (v.mass / 4 - turn);
  const double left = (target[0] - speed[0]) / dt, right = (target[1] - speed[1]) / dt;
  torque[0] = std::clamp(a * left + c * right, -v.torque, v.torque);
  torque[1] = std::clamp(c * left + a * right, -v.torque, v.torque);
}

/// Friction impulses [N s] of the floor on the wheels, forward, that end the slip of both wheels
/// [m/s] within the step; each at most `limit`. Two unknowns: what one wheel can't hold, the other
/// is solved for again.
void frictionImpulses(const Vehicle& v, const double slip[2], double limit, double impulse[2]) {
  const double own =
      1 / v.mass + v.half_gap * v.half_gap / v.inertia + v.radius * v.radius / v.wheel_inertia;
  const double other = 1 / v.mass - v.half_gap * v.half_gap / v.inertia;
  const double determinant = own * own - other * other;
  impulse[0] = (-own * slip[0] + other * slip[1]) / determinant;
  impulse[1] = (-own * slip[1] + other * slip[0]) / determinant;
  for (int wheel = 0; wheel < 2; ++wheel) {
    if (std::abs(impulse[wheel]) <= limit) continue;
    impulse[wheel] = std::copysign(limit, impulse[wheel]);
    const int rest = 1 - wheel;
    impulse[rest] = std::clamp(-(slip[rest] + other * impulse[wheel]) / own, -limit, limit);
    return;
  }
}

}  // namespace

void applyTraction(Fleet& fleet, int i, double gravity, double dt) {
  const Vehicle v = vehicle(fleet.robots[i], gravity);
  const double c = std::cos(fleet.yaw[i]), s = std::sin(fleet.yaw[i]);
  double forward = c * fleet.vx[i] + s * fleet.vy[i];
  double sideways = -s * fleet.vx[i] + c * fleet.vy[i];
  double turn = fleet.yaw_rate[i];
  double speed[2] = {fleet.wheel_speed[0][i], fleet.wheel_speed[1][i]};
  const double target[2] = {fleet.wheel_target[0][i], fleet.wheel_target[1][i]};

  // Sideways both wheels grip the floor as one: they share the axle.
  const double grip = v.grip * dt;
  const double hold = std::clamp(-v.mass * sideways, -2 * grip, 2 * grip);
  sideways += hold / v.mass;
  // Coulomb's circle: what holds sideways is not there to drive.
  const double limit =
      grip == kUnlimited ? kUnlimited : std::sqrt(std::max(0.0, grip * grip - hold * hold / 4));

  double torque[2];
  motorTorques(v, speed, target, dt, torque);
  double slip[2];
  for (int wheel = 0; wheel < 2; ++wheel) {
    speed[wheel] += torque[wheel] * dt / v.wheel_inertia;
    const double over_floor = forward + (wheel == 0 ? -1 : 1) * turn * v.half_gap;
    slip[wheel] = over_floor - v.radius * speed[wheel];
  }
  double impulse[2];
  frictionImpulses(v, slip, limit, impulse);
  forward += (impulse[0] + impulse[1]) / v.mass;
  turn += (impulse[1] - impulse[0]) * v.half_gap / v.inertia;

  for (int wheel = 0; wheel < 2; ++wheel) {
    fleet.wheel_speed[wheel][i] = speed[wheel] - impulse[wheel] * v.radius / v.wheel_inertia;
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

double turningLimit(const Robot& robot, double gravity) {
  const Vehicle v = vehicle(robot, gravity);
  const double force = std::min(v.torque / v.radius, v.grip);
  const double spin = v.wheel_inertia * v.half_gap / (v.radius * v.radius);
  return 2 * force * v.half_gap / (v.inertia + 2 * spin * v.half_gap);
}

bool atRest(const Fleet& fleet, int i) {
  return std::abs(fleet.vx[i]) < kRestSpeed && std::abs(fleet.vy[i]) < kRestSpeed &&
         std::abs(fleet.yaw_rate[i]) < kRestSpeed && fleet.wheel_target[0][i] == 0 &&
         fleet.wheel_target[1][i] == 0;
}

}  // namespace kiva
