// SPDX-License-Identifier: Apache-2.0
//
// Where on the floor a person finds room.
#pragma once

#include "core/state/scene.h"

namespace kiva {

/// How much farther off than they want the nearest thing would be if they stood at (x, y) [m];
/// negative: it is too near. Of robots the circle counts in which they turn.
double roomAt(const Scene& world, const Walker& walker, double x, double y);

}  // namespace kiva
