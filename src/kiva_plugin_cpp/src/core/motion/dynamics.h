// SPDX-License-Identifier: Apache-2.0
//
// What moves in a step: robots by arrays or by Bullet, storage units and other bodies by Bullet.
#pragma once

#include "core/state/motion_view.h"

namespace kiva {

/// Motors, floor and joints act: velocities change, positions stay.
void actuate(MotionView& world);
/// After Bullet's step: everybody's new poses, by arrays or from bodies.
void integrate(MotionView& world);

/// Bodies that sleep look again whether they should.
void wakeBodies(const ModelTable& models);

}  // namespace kiva
