// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/contact_log.h"
#include "core/state/motion_view.h"

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
