// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/motion_view.h"
#include "core/state/world/contact_log.h"

namespace kiva {

/// What contact between models changes: which of them Bullet steps, and what is known of their
/// collisions.
struct ContactView : MotionView {
  Physics& physics;
  ModelTable& models;
  ContactLog& contact_log;
  ExternalInputs& external_inputs;
};

}  // namespace kiva
