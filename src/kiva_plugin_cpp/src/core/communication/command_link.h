// SPDX-License-Identifier: Apache-2.0
//
// Carries commands to the robots: without delay, or by a radio that delays and loses them.
#pragma once

#include "core/state/robots/command_link.h"
#include "core/state/robots/inbox.h"
#include "core/state/views/scene.h"

namespace kiva {

/// Sends a command. Commands that stop or resume robots are wired, and never late.
void send(CommandLink& link, Inbox& inbox, const Scene& world, PendingCommand command);
/// Moves the commands that have arrived by now into the inbox.
void receive(CommandLink& link, Inbox& inbox, const Clock& clock);

}  // namespace kiva
