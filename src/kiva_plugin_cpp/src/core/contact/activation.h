// SPDX-License-Identifier: Apache-2.0
//
// Moves models into Bullet that may touch others. A robot with nothing near is integrated in
// arrays, and a storage unit with no robot near is a pose. Both become bodies when another model
// could reach them, and leave Bullet again when none can.
#pragma once

#include "core/state/views/contact_view.h"

namespace kiva {

/// Determines which models are near each other, lets them enter or leave Bullet, and fills
/// StepSchedule::stepped_singly: the robots that are awake and do not cruise, in the fleet's order.
void updateActivation(ContactView& world);
/// Puts a robot or storage unit into Bullet for a while.
void activate(ContactView& world, Model& model);
/// Takes a model out of Bullet at once; its pose stays.
void deactivate(ContactView& world, Model& model);
/// Rebuilds a model's body in Bullet after a change of its mass, shape or place.
void rebuildBody(ContactView& world, Model& model);
/// Leaves a storage unit to Bullet until it stands on its legs again.
void letFall(ContactView& world, Model& model);

}  // namespace kiva
