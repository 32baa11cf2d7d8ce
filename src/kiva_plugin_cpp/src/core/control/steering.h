// SPDX-License-Identifier: Apache-2.0
//
// Hands robots over to clients that drive them by velocities, and back to the grid.
#pragma once

#include "core/state/robots/steering.h"
#include "core/state/views/task_view.h"

namespace kiva {

/// Hands an idle robot over. Throws Refusal.
void beginSteering(TaskView& world, int robot);
/// Gives a steered robot back to the grid. Throws Refusal, with what to do, unless it stands on a
/// grid point, along the grid.
void endSteering(TaskView& world, int robot);
/// Sets the velocity that a steered robot is asked for, within its limits. Warns once of a robot
/// that is asked for more. Throws Refusal if it is not steered, or a number is not finite.
void steer(TaskView& world, int robot, const DriveVelocity& asked);

}  // namespace kiva
