// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kiva_plugin_cpp/command.h"

namespace kiva {

/// A command that its robot has not answered yet.
struct PendingCommand {
  Command command;
  FollowPath path;  ///< The path that the command stands for, if it is kFollow; else empty.
};

}  // namespace kiva
