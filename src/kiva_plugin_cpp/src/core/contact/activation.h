// SPDX-License-Identifier: Apache-2.0
//
// Bullet holds what may touch. A robot with nothing near is integrated in arrays, a storage unit
// that nobody comes near is a pose; both become bodies when something could reach them, and leave
// Bullet again when nothing can.
#pragma once

#include "core/state/contact_view.h"

namespace kiva {

/// Finds who is near whom, lets models enter or leave Bullet, and fills WorldState::stepped_singly:
/// the robots that are awake and do not cruise, in the fleet's order.
void updateActivation(ContactView& world);
/// Puts a robot or storage unit into Bullet for the next while.
void activate(ContactView& world, Model& model);
/// Takes a model out of Bullet at once; its pose stays.
void deactivate(ContactView& world, Model& model);
/// It has another mass, shape or place: if it is in Bullet, it gets a new body.
void rebuildBody(ContactView& world, Model& model);
/// Leaves a storage unit to Bullet until it stands on its legs again.
void letFall(ContactView& world, Model& model);

}  // namespace kiva
