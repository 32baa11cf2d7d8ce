// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/fleet_plugin.h"

namespace kiva {

/// Brakes a robot before obstacles that its laser sees.
class LaserPlugin : public FleetPlugin {
 public:
  const char* filename() const override { return "libkiva_laser.so"; }
  void configure(Robot& robot, const Parameters& parameters) const override;
  void react(TaskView& world, const std::vector<int>& sighted) const override;
};

}  // namespace kiva
