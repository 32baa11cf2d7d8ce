// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

#include "kiva_plugin_cpp/world.h"

namespace kiva_ros {

/// A wheel that a plugin drives by its joint's motor.
struct WheelMotor {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  std::string joint;
  double applied = kUnknown;  ///< The speed that the motor was set to last [rad/s].

  /// Sets the motor to that speed [rad/s], unless it is set to it already.
  void drive(kiva::World& world, const std::string& model, double speed, double torque) {
    if (speed == applied) return;
    const auto state = world.joint(model, joint);
    if (!state) return;
    kiva::JointSettings settings = state->settings;
    settings.motor_speed = applied = speed;
    settings.motor_effort = torque;
    world.setJoint(model, joint, settings);
  }
};

}  // namespace kiva_ros
