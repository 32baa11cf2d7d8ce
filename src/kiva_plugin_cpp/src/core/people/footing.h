// SPDX-License-Identifier: Apache-2.0
//
// Tells where on the floor a person has room to stand.
#pragma once

#include "core/state/views/scene.h"

namespace kiva {

/// Returns by how much the nearest obstacle of a person at (x, y) is farther away than the distance
/// that the person keeps [m]; negative: it is too near. A robot counts as its turning circle.
double clearanceAt(const Scene& world, const Walker& walker, double x, double y);

}  // namespace kiva
