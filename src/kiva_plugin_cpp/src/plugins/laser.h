// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/fleet_plugin.h"

namespace kiva {

/// Brakes a robot before what its laser sees in its way.
class LaserPlugin : public FleetPlugin {
 public:
  const char* filename() const override { return "libkiva_laser.so"; }
  void configure(Robot& robot, const Parameters& parameters) const override;
  void react(MotionView& world, const std::vector<int>& sighted) const override;
};

}  // namespace kiva
