// SPDX-License-Identifier: Apache-2.0
//
// Drops items off the boards of a storage unit that is hit or tips, and picks them up from the
// floor. Does nothing while the world's realism has no loads.
#pragma once

#include "core/state/views/model_view.h"

namespace kiva {

/// Starts items sliding on boards that the last step jolted or tilted, turns items at an edge into
/// bodies (FELL), and picks up those that are due (PICKED_UP).
void stepFallingItems(ModelView& world);

/// Implement World::fallenItems and World::pickUp.
std::vector<FallenItem> listFallenItems(const Scene& world);
void pickUp(ModelView& world, const std::string& item);

}  // namespace kiva
