// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

#include "core/state/robots/pending_command.h"

namespace kiva {

/// A command on its way to its robot.
struct CommandMessage {
  std::uint64_t due = 0;  ///< The total step at which it arrives.
  PendingCommand pending;
};

/// The radio by which commands reach the robots.
struct CommandLink {
  std::deque<CommandMessage> messages;  ///< In the order in which they arrive.
  std::uint64_t sent = 0;               ///< Messages, ever.
};

}  // namespace kiva
