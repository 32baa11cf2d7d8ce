// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/model_view.h"

namespace kiva {

/// Determines height, extent and friction of the floor from the level surfaces of all static
/// models. The largest surface determines height and friction; a plane only if there is no large
/// surface. If the height has changed, robots and storage units are moved to it.
void measureFloor(ModelView& world);

/// Determines the surfaces that grip differently from the largest one, if the floor or the robots
/// have changed since the last call. A surface on which every robot's wheels hold as well does not
/// count.
void findFloorParts(const Scene& world, FloorState& floor, EventLog& log);

}  // namespace kiva
