// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kiva_plugin_cpp/world.h"

namespace kiva {

/// Commands the wheel motors of an idle robot to speeds [rad/s], from the next step until its next
/// command. Speeds are limited to its top speed; motors give all their torque, and the laser does
/// not stop it. Returns false, with nothing changed, if the robot has a command.
bool setWheelSpeeds(World& world, int robot, double left, double right);

}  // namespace kiva
