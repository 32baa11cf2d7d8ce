// SPDX-License-Identifier: Apache-2.0
#include "core/motion/driving/drives.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/motion/joints/jointed.h"
#include "core/motion/wheels/ground.h"

namespace kiva {
namespace {

constexpr double kGripReserve = 0.9;    // share of the grip that plans use
constexpr double kLeastPlanned = 0.05;  // [m/s²]; plans need a positive one
constexpr double kGripsAll = 1e16;  // Coulomb coefficient of a floor where the wheels' own decides

double plannedLimit(const Scene& world, int robot, double (*limit)(const Vehicle&),
                    double nominal) {
  if (world.fleet.robots[robot].drive.acceleration == 0) return 0;
  const double held = std::min(nominal, limit(plannedVehicle(world, robot)));
  return std::min(held, loadLimit(world, robot));
}

}  // namespace

double loadLimit(const Scene& world, int robot) {
  if (!world.settings.realism.loads.enabled) return std::numeric_limits<double>::infinity();
  const double tips = tippingAcceleration(world.fleet.robots[robot], world.settings.gravityDown());
  return std::max(kLeastPlanned, world.settings.realism.loads.tipping_share * tips);
}

Vector3 centreFromOrigin(const Fleet& f, int robot) {
  const Vehicle vehicle = vehicleOf(f.robots[robot], {});
  const double c = std::cos(f.yaw[robot]), s = std::sin(f.yaw[robot]);
  return {c * vehicle.centre[0] - s * vehicle.centre[1],
          s * vehicle.centre[0] + c * vehicle.centre[1], 0};
}

Vehicle plannedVehicle(const Scene& world, int robot) {
  const Ground ground{world.settings.gravityDown(), {kGripsAll, kGripsAll}};
  const Robot& r = world.fleet.robots[robot];
  const bool is_jointed = r.drive.drive == Drive::kJointed;
  Vehicle vehicle = is_jointed ? jointedVehicle(world, robot, ground) : vehicleOf(r, ground);
  const double expected = r.grip * std::min(r.drive.friction, knownFriction(world, robot));
  for (int wheel = 0; wheel < 2; ++wheel) {
    const double known = vehicle.friction[wheel] > 0 ? expected / vehicle.friction[wheel] : 1;
    vehicle.friction[wheel] *= known;
    vehicle.grip[wheel] *= known * kGripReserve;
  }
  return vehicle;
}

double plannedAcceleration(const Scene& world, int robot) {
  const double nominal = world.fleet.robots[robot].drive.acceleration;
  return std::min(plannedLimit(world, robot, drivingLimit, nominal),
                  plannedLimit(world, robot, brakingLimit, nominal));
}

double plannedBraking(const Scene& world, int robot) {
  const DriveParameters& drive = world.fleet.robots[robot].drive;
  if (drive.acceleration == 0) return drive.emergency_deceleration;
  return plannedLimit(world, robot, brakingLimit, drive.emergency_deceleration);
}

}  // namespace kiva
