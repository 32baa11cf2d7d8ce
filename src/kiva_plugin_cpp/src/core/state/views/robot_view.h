// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/scene.h"

namespace kiva {

/// Writes what robots know, plan and do: rooms that change nothing else of the world.
struct RobotView : Scene {
  FleetState& fleet;
};

}  // namespace kiva
