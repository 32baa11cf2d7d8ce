// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

#include "core/state/robots/pending_command.h"

namespace kiva {

/// Commands that have arrived and are answered at the next step.
struct Inbox {
  std::deque<PendingCommand> pending;
  std::uint32_t last_number = 0;  ///< The number of the last answered command.
};

}  // namespace kiva
