// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/world_state.h"

namespace kiva {

Pose unitPose(const WorldState& world, int unit);
Pose itemPose(const WorldState& world, int item);
/// Of the tower's plate on which a unit rests, in world.
Pose towerPose(const WorldState& world, int robot);
Pose basePose(const WorldState& world, int robot);
/// Height of the unit's underside above the floor where the tower meets it [m].
double underside(const WorldState& world, int unit);
/// Height that the robot's tower has to rise until it meets that unit [m].
double towerGap(const WorldState& world, int robot, int unit);
/// Distance of the centres of robot and unit on the floor [m].
double unitDistance(const WorldState& world, int robot, int unit);

/// The unit now rests on the robot and loads it.
void takeUp(WorldState& world, int robot, int unit);
/// The unit stands on the floor again, upright beneath where it was.
void putDown(WorldState& world, int robot);
/// The robot is without its unit from now on, whatever becomes of that.
void unload(WorldState& world, int robot);
/// Whether the unit stands on its legs, as a robot needs it to.
bool standsUpright(const WorldState& world, int unit);

/// The storage unit whose shelves hold that point, -1 = none.
int unitAt(const WorldState& world, const Vector3& point);
/// An item of that mass [kg] came onto the unit; negative: left it.
void addMass(WorldState& world, int unit, double mass);

}  // namespace kiva
