// SPDX-License-Identifier: Apache-2.0
//
// What lies ahead of a steered robot, on the arc that it drives.
#pragma once

#include "core/state/robots/scans.h"
#include "core/state/views/robot_view.h"

namespace kiva {

/// Returns whether the robot is steered ahead, and sees what lies there.
bool looksAlongArc(const FleetState& fleet, int robot);
/// Measures the room ahead of a steered robot with its laser. Callable from any thread, for
/// different robots.
void lookAlongArc(RobotView& world, const Scans& scans, int robot);

}  // namespace kiva
