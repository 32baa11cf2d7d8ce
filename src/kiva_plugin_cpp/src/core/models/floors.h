// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/model_view.h"

namespace kiva {

/// Finds height, extent and friction of the floor in the level surfaces of all static models. The
/// largest tells height and friction; a plane only where nothing large lies on it. If the height is
/// another than it was, everything is fitted to it: robots and storage units stand on it.
void measureFloor(ModelView& world);

/// Finds the surfaces that grip otherwise than the largest one, if the floor or the robots have
/// changed since the last time. Surfaces on which every robot's wheels hold as well are no others.
void findFloorParts(ModelView& world);

}  // namespace kiva
