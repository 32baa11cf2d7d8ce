// SPDX-License-Identifier: Apache-2.0
//
// How a person gets past what is in the way.
#pragma once

#include <vector>

#include "core/state/scene.h"

namespace kiva {

/// Points from where a person stands around what stands there now to (x, y), that one first; empty
/// if there is no way within reach.
std::vector<PathPoint> wayAround(const Scene& world, const Walker& walker, double x, double y);

}  // namespace kiva
