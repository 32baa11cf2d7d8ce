// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ros/messages/order.h"

namespace kiva_ros {

/// Observes the simulation. All calls come from the step thread.
class StepHook {
 public:
  virtual ~StepHook() = default;
  /// Called when a command was posted; its event follows at the next step.
  virtual void onCommand(const Order& /*order*/) {}
  /// Called before everything is put back to where it was spawned.
  virtual void beforeReset(kiva::World& /*world*/) {}
  /// Called after models were added, removed or moved by a request.
  virtual void onChange() {}
  /// Called before each step; returns false to prevent it.
  virtual bool beforeStep(kiva::World& /*world*/) { return true; }
  virtual void afterStep(kiva::World& /*world*/) {}
};

}  // namespace kiva_ros
