// SPDX-License-Identifier: Apache-2.0
//
// The way of commands to the robots: at once, or as a radio brings them.
#pragma once

#include "core/state/command_link.h"
#include "core/state/inbox.h"
#include "core/state/scene.h"

namespace kiva {

/// Sends a command; `path` is what it stands for, if it is to follow one. What stops robots or lets
/// them go on has a wire of its own, and is never late.
void send(CommandLink& link, Inbox& inbox, const Scene& world, PendingCommand command);
/// Takes in what has come by now.
void receive(CommandLink& link, Inbox& inbox, const Clock& clock);

}  // namespace kiva
