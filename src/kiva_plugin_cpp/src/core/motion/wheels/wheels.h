// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kiva_plugin_cpp/world.h"

namespace kiva {

/// Sets the speeds that the wheel motors of an idle robot are commanded [rad/s], from the
/// next step on and until its next command: no more than its top speed, and with all the torque
/// that they have; its laser does not stop it. Returns false, and nothing changes, if it is at a
/// command.
bool setWheelSpeeds(World& world, int robot, double left, double right);

}  // namespace kiva
