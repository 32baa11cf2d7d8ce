// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/fleet_plugin.h"

namespace kiva {

/// Turns in place: a triangular yaw rate profile within the limits of motors and floor.
class RotationPlugin : public FleetPlugin {
 public:
  const char* filename() const override { return "libkiva_rotation.so"; }
  void configure(Robot& robot, const Parameters& parameters) const override;
  void control(ContactView& world) const override;
};

/// Returns the acceleration of a turn by that angle [rad/s²], within the limits of motors and
/// floor; 0 = at once.
double turnAcceleration(const Scene& world, int i, double angle);
/// Returns the speed that no turn exceeds [rad/s].
double turnSpeed(const Robot& robot, double dt);

}  // namespace kiva
