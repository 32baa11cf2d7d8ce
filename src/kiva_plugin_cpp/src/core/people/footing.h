// SPDX-License-Identifier: Apache-2.0
//
// The places on the floor where a person has room to stand.
#pragma once

#include "core/state/views/scene.h"

namespace kiva {

/// Returns the distance of a person at (x, y) from the nearest obstacle, less the distance that
/// people keep [m]; negative: too close. A robot counts as its turning circle.
double clearanceAt(const Scene& world, const Walker& walker, double x, double y);

}  // namespace kiva
