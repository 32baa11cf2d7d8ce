// SPDX-License-Identifier: Apache-2.0
//
// Drives robots by the velocities that clients ask for.
#pragma once

#include "core/state/views/motion_view.h"

namespace kiva {

/// Commands the wheels of all steered robots for this step: they follow what was asked within the
/// robot's accelerations, and stop it before an obstacle that its laser saw, which it reports.
void driveSteered(MotionView& world);

}  // namespace kiva
