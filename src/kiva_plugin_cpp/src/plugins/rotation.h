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

}  // namespace kiva
