// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/fleet_plugin.h"

namespace kiva {

/// Raises and lowers the tower; where it meets a storage unit, the unit goes along.
class LiftPlugin : public FleetPlugin {
 public:
  const char* filename() const override { return "libkiva_lift.so"; }
  void configure(Robot& robot, const Parameters& parameters) const override;
  void control(ContactView& world) const override;
};

}  // namespace kiva
