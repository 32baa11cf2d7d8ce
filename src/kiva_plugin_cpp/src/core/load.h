// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parts.h"

namespace kiva {

Pose unitPose(const Parts& parts, int unit);
Pose itemPose(const Parts& parts, int item);
/// Of the tower's plate on which a unit rests, in world.
Pose towerPose(const Parts& parts, int robot);
Pose basePose(const Parts& parts, int robot);
/// Height of the unit's underside above the floor where the tower meets it [m].
double underside(const Parts& parts, int unit);
/// Height that the robot's tower has to rise until it meets that unit [m].
double towerGap(const Parts& parts, int robot, int unit);
/// Distance of the centres of robot and unit on the floor [m].
double unitDistance(const Parts& parts, int robot, int unit);

/// The unit now rests on the robot and loads it.
void takeUp(Parts& parts, int robot, int unit);
/// The unit stands on the floor again, upright beneath where it was.
void putDown(Parts& parts, int robot);
/// The robot is without its unit from now on, whatever becomes of that.
void unload(Parts& parts, int robot);
/// Whether the unit stands on its legs, as a robot needs it to.
bool standsUpright(const Parts& parts, int unit);

/// The storage unit whose shelves hold that point, -1 = none.
int unitAt(const Parts& parts, const Vector3& point);
/// An item of that mass [kg] came onto the unit; negative: left it.
void addMass(Parts& parts, int unit, double mass);

}  // namespace kiva
