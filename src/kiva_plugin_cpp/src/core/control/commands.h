// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/contact_log.h"
#include "core/state/inbox.h"
#include "core/state/motion_view.h"

namespace kiva {

/// Answers all queued commands, and gives the accepted ones to their robots.
void acceptCommands(MotionView& world, Inbox& inbox);
/// Robots that were in a collision stop.
void haltCrashed(MotionView& world, ContactLog& contacts);

}  // namespace kiva
