// SPDX-License-Identifier: Apache-2.0
//
// Bullet holds what may touch. A robot with nothing near is integrated in arrays, a storage unit
// that nobody comes near is a pose; both become bodies when something could reach them, and leave
// Bullet again when nothing can.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// Finds who is near whom, lets models enter or leave Bullet, and fills WorldState::stepped_singly:
/// the robots that are awake and do not cruise, in the fleet's order.
void updateActivation(WorldState& world);
/// Whether it is a model that enters Bullet for a while only: a robot or a storage unit.
bool canActivate(const Model& model);
/// Its bodies, at its present pose.
ModelBodies buildActivated(const WorldState& world, const Model& model);
/// Puts a robot or storage unit into Bullet for the next while.
void activate(WorldState& world, Model& model);
/// Takes a model out of Bullet at once; its pose stays.
void deactivate(WorldState& world, Model& model);
/// After its load has changed: an activated robot gets a body with the new one.
void rebuildBody(WorldState& world, int robot);
/// Motors and floor act on the robots: velocities change, positions stay.
void drive(WorldState& world);
/// After Bullet's step: everybody's new poses, by arrays or from bodies.
void settle(WorldState& world);

/// A robot with its load as one body that slides and turns on the floor plane.
ModelBodies buildPlanar(const WorldState& world, int robot);

}  // namespace kiva
