// SPDX-License-Identifier: Apache-2.0
//
// The way of commands to the robots: at once, or as a radio brings them.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// Sends a command; `path` is what it stands for, if it is to follow one. What stops robots or lets
/// them go on has a wire of its own, and is never late.
void send(WorldState& world, const Command& command, FollowPath path = {});
/// Takes in what has come by now.
void receive(WorldState& world);

/// Nothing is under way any more, to robots or from them; they are where they are.
void forgetMessages(WorldState& world);

/// Nothing that was sent, to robots or by them, is under way any more.
void forgetMessages(WorldState& world);

}  // namespace kiva
