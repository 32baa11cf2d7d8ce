// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/scene.h"

namespace kiva {

/// Writes the fleet: the motion, knowledge and plans of robots.
struct RobotView : Scene {
  FleetState& fleet;
};

}  // namespace kiva
