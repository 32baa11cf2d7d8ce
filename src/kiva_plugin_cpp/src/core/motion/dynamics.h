// SPDX-License-Identifier: Apache-2.0
//
// What moves in a step: robots by arrays or by Bullet, storage units and other bodies by Bullet.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// Motors, floor and joints act: velocities change, positions stay.
void actuate(WorldState& world);
/// After Bullet's step: everybody's new poses, by arrays or from bodies.
void integrate(WorldState& world);

/// Bodies that sleep look again whether they should.
void wakeBodies(WorldState& world);

}  // namespace kiva
