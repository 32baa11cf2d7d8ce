// SPDX-License-Identifier: Apache-2.0
//
// Moves models into Bullet that may touch others. A robot with nothing near is integrated in
// arrays, a storage unit with no robot near is a pose; both become bodies when another model could
// reach them, and leave Bullet again when none can.
#pragma once

#include "core/state/views/contact_view.h"

namespace kiva {

/// Finds which models are near each other, lets them enter or leave Bullet, and fills
/// StepSchedule::stepped_singly: the robots that are awake and do not cruise, in the fleet's order.
void updateActivation(ContactView& world);
/// Puts a robot or storage unit into Bullet for the next while.
void activate(ContactView& world, Model& model);
/// Takes a model out of Bullet at once; its pose stays.
void deactivate(ContactView& world, Model& model);
/// Gives a model in Bullet a new body, since its mass, shape or place has changed.
void rebuildBody(ContactView& world, Model& model);
/// Leaves a storage unit to Bullet until it stands on its legs again.
void letFall(ContactView& world, Model& model);

}  // namespace kiva
