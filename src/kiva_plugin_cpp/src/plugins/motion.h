// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/fleet_plugin.h"

namespace kiva {

/// Drives straight segments: a trapezoidal speed profile along the line, steered by the wheels.
class MotionPlugin : public FleetPlugin {
 public:
  const char* filename() const override { return "libkiva_motion.so"; }
  void configure(Robot& robot, const Parameters& parameters) const override;
  void control(ContactView& world) const override;
};

/// Asks the wheels of robot `i` for a speed [m/s] along its heading and a yaw rate [rad/s].
void setWheels(FleetState& fleet, int i, double speed, double yaw_rate);

/// Tolerances of a goal.
constexpr double kThereDistance = 1e-5;  // [m]
constexpr double kThereAngle = 1e-6;     // [rad]
bool stands(const Fleet& fleet, int i);

/// Longest time that a robot may take to reach a segment's end after its reference has.
constexpr double kOverdue = 2.0;  // [s]

/// Locks the wheels of a robot that is to halt, and ends the command once it stands. Returns
/// whether the robot is to halt.
bool halting(TaskView& world, int i);

}  // namespace kiva
