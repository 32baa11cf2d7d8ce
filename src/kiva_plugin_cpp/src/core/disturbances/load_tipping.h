// SPDX-License-Identifier: Apache-2.0
//
// Loads that stand on a robot, and tip off it where it brakes or is hit too hard; nothing while the
// world's realism has no loads.
#pragma once

#include "core/state/model_view.h"

namespace kiva {

/// What the robots' motion in the last step did to what they carry: TIPPED for each load that goes
/// over its edge. It is a body of its own from then on, and its robot stops.
void swayLoads(ModelView& world);

}  // namespace kiva
