// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/robots/inbox.h"
#include "core/state/robots/shadows.h"
#include "core/state/views/motion_view.h"
#include "core/state/world/contact_log.h"

namespace kiva {

/// Answers all queued commands except those to shadows, and gives the accepted ones to their
/// robots.
void acceptCommands(TaskView& world, Obstacles& obstacles, Inbox& inbox, const Shadows& shadows);
/// Stops the robots that were in a collision.
void haltCollidedRobots(TaskView& world, ContactLog& contacts);

}  // namespace kiva
