// SPDX-License-Identifier: Apache-2.0
//
// The geometry of storage units for a robot beneath them.
#pragma once

#include "core/state/views/scene.h"

namespace kiva {

/// Returns the height of the unit's underside above the floor where the tower meets it [m].
double underside(const Scene& world, int unit);
/// Returns the height by which the robot's tower must rise to meet that unit [m].
double towerGap(const Scene& world, int robot, int unit);
/// Returns the distance of the centres of robot and unit on the floor [m].
double unitDistance(const Scene& world, int robot, int unit);
/// Returns whether the unit stands on its legs, as robots require.
bool standsUpright(const Scene& world, int unit);
/// Returns the storage unit whose shelves contain that point, -1 = none.
int unitAt(const Scene& world, const Vector3& point);

}  // namespace kiva
