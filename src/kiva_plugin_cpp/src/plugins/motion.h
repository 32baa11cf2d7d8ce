// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/fleet_plugin.h"

namespace kiva {

/// Drives straight segments: a trapezoid of speed along the line, the wheels steering back onto it.
class MotionPlugin : public FleetPlugin {
 public:
  const char* filename() const override { return "libkiva_motion.so"; }
  void configure(Robot& robot, const Parameters& parameters) const override;
  void control(ContactView& world) const override;
};

/// Asks the wheels of robot `i` for a speed [m/s] along its heading and a yaw rate [rad/s].
void setWheels(FleetState& fleet, int i, double speed, double yaw_rate);

/// How near is there.
constexpr double kThereDistance = 1e-5;  // [m]
constexpr double kThereAngle = 1e-6;     // [rad]
bool stands(const Fleet& fleet, int i);

/// How long a robot may be at a segment's end without having come to it.
constexpr double kOverdue = 2.0;  // [s]

/// If the robot is to halt: locks the wheels, and ends the command once it stands. Returns whether
/// it is.
bool halting(MotionView& world, int i);

}  // namespace kiva
