// SPDX-License-Identifier: Apache-2.0
//
// Bullet holds what may touch. A robot with nothing near is integrated in arrays, a storage unit
// that nobody comes near is a pose; both become bodies when something could reach them, and leave
// Bullet again when nothing can.
#pragma once

#include "parts.h"

namespace kiva {

/// Finds who is near whom, lets models enter or leave Bullet, and fills Parts::active: the robots
/// that are awake and do not cruise, in the fleet's order.
void updateEngagement(Parts& parts);
/// Whether it is a model that enters Bullet for a while only: a robot or a storage unit.
bool canEngage(const Model& model);
/// Its bodies, at its present pose.
ModelBodies buildEngaged(const Parts& parts, const Model& model);
/// Puts a robot or storage unit into Bullet for the next while.
void engage(Parts& parts, Model& model);
/// Takes a model out of Bullet at once; its pose stays.
void disengage(Parts& parts, Model& model);
/// After its load has changed: an engaged robot gets a body with the new one.
void rebuildBody(Parts& parts, int robot);
/// Motors and floor act on the robots: velocities change, positions stay.
void drive(Parts& parts);
/// After Bullet's step: everybody's new poses, by arrays or from bodies.
void settle(Parts& parts);

/// A robot with its load as one body that slides and turns on the floor plane.
ModelBodies buildPlanar(const Parts& parts, int robot);

}  // namespace kiva
