// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ros/messages/order.h"

namespace kiva_ros {

/// Called by the step thread, on it, as things happen.
class StepHook {
 public:
  virtual ~StepHook() = default;
  /// A command was posted; it is answered at the next step.
  virtual void onCommand(const Order& /*order*/) {}
  /// Everything is about to go back to where it was spawned.
  virtual void beforeReset(kiva::World& /*world*/) {}
  /// Models came, went or were moved from outside.
  virtual void onChange() {}
  /// What is to happen before the next step; false if there is to be none.
  virtual bool beforeStep(kiva::World& /*world*/) { return true; }
  virtual void afterStep(kiva::World& /*world*/) {}
};

}  // namespace kiva_ros
