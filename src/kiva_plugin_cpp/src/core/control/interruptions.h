// SPDX-License-Identifier: Apache-2.0
//
// What comes between a robot and the end of its command, by a client's wish.
#pragma once

#include "core/state/motion_view.h"

namespace kiva {

/// The robot's command ends in DONE at the next grid point where it can stop, or, a lift, when it
/// is over. Throws Refusal if there is nothing to cancel.
void cancel(MotionView& world, int robot);
/// Wheels and tower stop as hard as they can, and stand until it may go on.
void stop(MotionView& world, int robot);
/// It goes on with what it did, from where it is now.
void goOn(MotionView& world, int robot);
/// It stood, or can do less than was planned with: what it is at begins again, from where it is.
void planAnew(MotionView& world, int robot);

}  // namespace kiva
