// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/motion_view.h"
#include "core/state/world/contact_log.h"

namespace kiva {

/// Writes contact: beside motion, the bodies that Bullet steps and the log of collisions.
struct ContactView : MotionView {
  Physics& physics;
  ContactLog& contact_log;
  ExternalInputs& external_inputs;
};

}  // namespace kiva
