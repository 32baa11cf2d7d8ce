// SPDX-License-Identifier: Apache-2.0
//
// Drops items off the boards of a storage unit which is hit or tips, and picks them up from the
// floor; does nothing while the world's realism has no loads.
#pragma once

#include "core/state/views/model_view.h"

namespace kiva {

/// Sets items sliding on boards that the last step jolted or tilted, turns those that come to the
/// edge into bodies (FELL), and picks up those that are due (PICKED_UP).
void stepFallingItems(ModelView& world);

/// Implement World::fallenItems and World::pickUp.
std::vector<FallenItem> listFallenItems(const Scene& world);
void pickUp(ModelView& world, const std::string& item);

}  // namespace kiva
