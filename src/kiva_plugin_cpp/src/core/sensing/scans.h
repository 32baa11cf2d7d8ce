// SPDX-License-Identifier: Apache-2.0
//
// The robots' lasers: when they scan, and what they see.
#pragma once

#include <vector>

#include "core/state/world_state.h"

namespace kiva {

/// Steps between two scans of a robot.
std::uint64_t scanPeriod(const WorldState& world, const Robot& robot);
/// Fills WorldState::scans_due: whose lasers turn in a scan at this step, in the fleet's order. The
/// fleet's scans are spread over the period.
void findDueScans(WorldState& world);

/// Gives the robot the directions of its laser's rays, shared with others of the same kind.
void setRays(WorldState& world, Robot* robot);

/// Where a robot's laser is, and its heading, in world.
struct Sensor {
  double x, y, z;  ///< [m]
  double c, s;     ///< Cosine and sine of the heading.
};
Sensor sensorOf(const WorldState& world, int robot);

/// Casts each ray of the robot's laser, as far as limit(ray) [m].
template <typename Limit>
void castRays(const WorldState& world, int robot, Limit limit, std::vector<RayHit>* hits) {
  const Robot& r = world.fleet.robots[robot];
  const RayFan& fan = world.ray_fans[r.ray_fan];
  const Sensor at = sensorOf(world, robot);
  hits->resize(r.laser.rays);
  for (int ray = 0; ray < r.laser.rays; ++ray) {
    const double dx = at.c * fan.c[ray] - at.s * fan.s[ray];
    const double dy = at.s * fan.c[ray] + at.c * fan.s[ray];
    (*hits)[ray] = world.obstacles.cast(at.x, at.y, at.z, dx, dy, limit(ray), robot);
  }
}

/// A whole scan.
void castScan(const WorldState& world, int robot, std::vector<RayHit>* hits);

}  // namespace kiva
