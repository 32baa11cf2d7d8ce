// SPDX-License-Identifier: Apache-2.0
//
// A storage unit that is pushed slides on its feet, and rocks a little. While that is all, its body
// is planar: it has no contacts with the floor but friction at its feet. What pushes it off them is
// added up, and where that would tilt it visibly it becomes a whole body, with that momentum; when
// it stands on its feet again it is planar again.
#pragma once

#include "core/state/views/contact_view.h"

namespace kiva {

/// Returns whether the floor is such that a unit may be planar where it stands on its feet.
bool canSlideUpright(const Scene& world, const Model& model);
/// Returns the planar body of a unit that is like `description`, at model.pose.
ModelBodies buildUpright(const Scene& world, const Model& model, ModelDescription description);

/// Adds what pushed the units over in the last step.
void rock(ContactView& world);
/// Makes those whole that their feet hold no longer, and those planar that stand on them again.
void updateUprightness(ContactView& world);
/// Makes a planar unit whole at once, or all: their weight or the floor is another one.
void letTip(ContactView& world, Model& model);
void letAllTip(ContactView& world);

}  // namespace kiva
