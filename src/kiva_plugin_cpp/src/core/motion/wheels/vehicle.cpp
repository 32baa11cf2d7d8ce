// SPDX-License-Identifier: Apache-2.0
#include "core/motion/wheels/vehicle.h"

#include <algorithm>
#include <cmath>

namespace kiva {
namespace {

constexpr double kLeast = 1e-3;  // [m/s², rad/s²]; plans need a positive one

/// Returns the largest acceleration [m/s²] along the heading without yaw, at which each wheel gives
/// its share.
double alongLimit(const Vehicle& v, double lift) {
  double limit = kUnlimited;
  for (int wheel = 0; wheel < 2; ++wheel) {
    const double share = std::max(0.0, v.share(wheel));
    const double spin = v.wheel_inertia / (v.radius * v.radius);
    limit = std::min(limit, v.torque / v.radius / (share * v.mass + spin));
    limit = std::min(limit, v.grip[wheel] / (v.mass * (share + v.friction[wheel] * lift / 2)));
  }
  return std::max(limit, kLeast);
}

}  // namespace

double wheelFriction(const Robot& robot, int wheel, const Ground& ground) {
  return robot.grip *
         std::min({robot.drive.friction, robot.tyre_friction[wheel], ground.friction[wheel]});
}

Vehicle vehicleOf(const Robot& robot, const Ground& ground) {
  const DriveParameters& drive = robot.drive;
  Vehicle v;
  v.mass = robot.mass + robot.load_mass;
  double arm = 0;
  for (int axis = 0; axis < 2; ++axis) {
    v.centre[axis] =
        (robot.mass * robot.centre[axis] + robot.load_mass * robot.load_centre[axis]) / v.mass;
    arm += v.centre[axis] * v.centre[axis];
  }
  v.inertia = robot.inertia + robot.load_inertia - v.mass * arm;
  v.radius = drive.wheel_radius;
  v.half_separation = drive.wheel_separation / 2;
  v.wheel_inertia = drive.wheel_inertia;
  const bool ideal = drive.acceleration == 0;
  v.torque = ideal ? kUnlimited : drive.motor_torque;
  for (int wheel = 0; wheel < 2; ++wheel) {
    v.friction[wheel] = wheelFriction(robot, wheel, ground);
    const double weight = v.mass * ground.gravity * v.weight(wheel, drive.drive_wheel_load);
    v.grip[wheel] = ideal ? kUnlimited : v.friction[wheel] * weight;
  }
  return v;
}

double tippingAcceleration(const Robot& robot, double gravity) {
  if (robot.load_mass == 0 || robot.load_height <= 0) return kUnlimited;
  return gravity * robot.load_foothold / robot.load_height;
}

double drivingLimit(const Vehicle& vehicle) { return alongLimit(vehicle, vehicle.lift_ahead); }

double brakingLimit(const Vehicle& vehicle) { return alongLimit(vehicle, vehicle.lift_braking); }

double turningEffort(const Vehicle& v, double a, double speed) {
  const double half = v.half_separation, cx = v.centre[0], cy = v.centre[1];
  const double w2 = speed * speed;
  const double ahead = v.mass * (-a * cy - w2 * cx);  // force on the centre of mass [N]
  const double aside = v.mass * (a * cx - w2 * cy);
  const double difference = (v.inertia * a + cx * aside - cy * ahead) / half;
  double effort = 0;
  for (int wheel = 0; wheel < 2; ++wheel) {
    const double force = (ahead + (wheel == 0 ? -difference : difference)) / 2;
    const double spin = v.wheel_inertia * std::abs(a) * half / (v.radius * v.radius);
    effort = std::max(effort, (std::abs(force) + spin) * v.radius / v.torque);
    const double share = v.share(wheel);
    const double lift = std::max(v.lift_ahead, v.lift_braking);
    const double lifted =
        v.friction[wheel] * (std::abs(ahead) * lift / 2 + std::abs(aside) * v.lift_sideways);
    const double held = std::hypot(force, share * aside) + lifted;
    effort = std::max(effort, v.grip[wheel] > 0 ? held / v.grip[wheel] : kUnlimited);
  }
  return effort;
}

double turningLimit(const Vehicle& v, double angle) {
  // The load is highest halfway, at the largest speed; all forces are proportional to the
  // acceleration.
  double effort = 0;
  for (double a : {1.0, -1.0}) {
    for (double speed : {0.0, std::sqrt(angle)}) {
      effort = std::max(effort, turningEffort(v, a, speed));
    }
  }
  return effort > 0 ? std::max(1 / effort, kLeast) : kUnlimited;
}

}  // namespace kiva
