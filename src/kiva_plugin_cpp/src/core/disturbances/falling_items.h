// SPDX-License-Identifier: Apache-2.0
//
// Items that slide off the boards of a storage unit which is hit or tips, lie on the floor, and are
// picked up; nothing while the world's realism has no loads.
#pragma once

#include "core/state/model_view.h"

namespace kiva {

/// Which items the last step's jolts and tilts set sliding, which come to the edge of their boards
/// and become bodies, FELL, and which somebody picks up.
void dropItems(ModelView& world);

/// As World::fallenItems and World::pickUp say.
std::vector<FallenItem> fallenIn(const Scene& world);
void pickUp(ModelView& world, const std::string& item);

}  // namespace kiva
