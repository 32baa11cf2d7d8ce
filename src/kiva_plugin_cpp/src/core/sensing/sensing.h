// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// Steps between two scans of a robot.
std::uint64_t scanPeriod(const WorldState& world, const Robot& robot);
/// Fills WorldState::scans_due: whose lasers turn in a scan at this step, in the fleet's order. The
/// fleet's scans are spread over the period.
void findDueScans(WorldState& world);

/// Gives the robot the directions of its laser's rays, shared with others of the same kind.
void setRays(WorldState& world, Robot* robot);

void castScan(const WorldState& world, int robot, std::vector<RayHit>* hits);

/// The nearest obstacle in the corridor that the robot would sweep, as its laser sees it.
struct Ahead {
  double distance = 0;  ///< From the robot's centre, along its heading [m]; +inf = free.
  int model = -1;
  bool faces = false;  ///< What is nearest is a face across the way: it can be measured again.
};
Ahead lookAhead(const WorldState& world, int robot);

/// Whether the robot, standing or turning at (x, y), would touch anything.
bool isFree(const WorldState& world, int robot, double x, double y);
/// Whether that model stops this robot: a unit stops only a loaded one, or one that carries it.
bool blocks(const WorldState& world, int robot, int model);

}  // namespace kiva
