// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plugins/fleet_plugin.h"

namespace kiva {

/// Looks ahead while the robot drives, and stops it before what is in its way.
class LaserPlugin : public FleetPlugin {
 public:
  const char* filename() const override { return "libkiva_laser.so"; }
  void configure(Robot& robot, const Parameters& parameters) const override;
  void afterStep(WorldState& world) override;
};

}  // namespace kiva
