// SPDX-License-Identifier: Apache-2.0
//
// Searches a way for a person around an obstacle.
#pragma once

#include <vector>

#include "core/state/views/scene.h"

namespace kiva {

/// Returns the points of a way from the person around the present obstacles to (x, y), the goal
/// first; empty if there is no way within reach.
std::vector<PathPoint> findDetour(const Scene& world, const Walker& walker, double x, double y);

}  // namespace kiva
