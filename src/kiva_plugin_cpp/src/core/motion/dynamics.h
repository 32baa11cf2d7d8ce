// SPDX-License-Identifier: Apache-2.0
//
// The motion of a step: robots in arrays or in Bullet, storage units and other bodies in Bullet.
#pragma once

#include "core/state/views/motion_view.h"

namespace kiva {

/// Applies motors, floor and joints: changes velocities, and no positions.
void actuate(MotionView& world);
/// Updates all poses after Bullet's step, in arrays or from bodies.
void integrate(MotionView& world);

/// Wakes sleeping bodies.
void wakeBodies(ModelTable& models);

}  // namespace kiva
