// SPDX-License-Identifier: Apache-2.0
//
// Carries commands to the robots: at once, or delayed by a radio.
#pragma once

#include "core/state/robots/command_link.h"
#include "core/state/robots/inbox.h"
#include "core/state/views/scene.h"

namespace kiva {

/// Sends a command. Commands that stop robots or let them go on are wired, and never late.
void send(CommandLink& link, Inbox& inbox, const Scene& world, PendingCommand command);
/// Moves the commands that have arrived by now into the inbox.
void receive(CommandLink& link, Inbox& inbox, const Clock& clock);

}  // namespace kiva
