// SPDX-License-Identifier: Apache-2.0
//
// Planar bodies of storage units. A unit that is pushed slides on its feet, and rocks a little. As
// long as it does no more, its body is planar: its only contact with the floor is friction at its
// feet. Pushes that lift the feet are added up. A unit that they would tilt visibly gets a whole
// body with that momentum, and a planar one when it stands on its feet again.
#pragma once

#include "core/state/views/contact_view.h"

namespace kiva {

/// Returns whether a unit may be planar on this floor where it stands on its feet.
bool canSlideUpright(const Scene& world, const Model& model);
/// Returns the planar body of a unit with that description, at model.pose.
ModelBodies buildUpright(const Scene& world, const Model& model, ModelDescription description);

/// Adds the pushes on planar units in the last step.
void rock(const Scene& world, ModelTable& models);
/// Makes units whole whose feet no longer hold them, and units planar that stand on their feet
/// again.
void updateUprightness(ContactView& world);
/// Makes a planar unit whole at once, or all of them, after their weight or the floor has changed.
void letTip(ContactView& world, Model& model);
void letAllTip(ContactView& world);

}  // namespace kiva
