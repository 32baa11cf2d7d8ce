// SPDX-License-Identifier: Apache-2.0
#include "core/motion/wheels/wheels.h"

#include <algorithm>

#include "core/state/progress/tasks.h"
#include "core/state/world_state.h"

namespace kiva {

bool setWheelSpeeds(World& world, int robot, double left, double right) {
  FleetState& f = insideOf(world).fleet;
  if (f.tasks[robot].phase != Phase::kIdle) return false;
  if (f.failures[robot] & (bitOf(Failure::kMotor) | kEmptyBattery)) return false;
  const DriveParameters& drive = f.robots[robot].drive;
  const double most = drive.speed / drive.wheel_radius;
  const double speeds[2] = {left, right};
  for (int wheel = 0; wheel < 2; ++wheel) {
    f.wheel_target[wheel][robot] = std::clamp(speeds[wheel], -most, most);
  }
  if (left != 0 || right != 0) moved(f, robot);
  return true;
}

}  // namespace kiva
