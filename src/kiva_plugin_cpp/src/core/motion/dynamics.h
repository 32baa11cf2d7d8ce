// SPDX-License-Identifier: Apache-2.0
//
// What moves in a step: robots by arrays or by Bullet, storage units and other bodies by Bullet.
#pragma once

#include "core/state/views/motion_view.h"

namespace kiva {

/// Applies motors, floor and joints: velocities change, positions stay.
void actuate(MotionView& world);
/// Updates all poses after Bullet's step, by arrays or from bodies.
void integrate(MotionView& world);

/// Wakes sleeping bodies.
void wakeBodies(const ModelTable& models);

}  // namespace kiva
