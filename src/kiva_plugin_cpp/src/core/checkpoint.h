// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "parts.h"
#include "plugin_states.h"

namespace kiva {

/// The whole state as bytes. What Bullet and the obstacles remember of how they came to be is not
/// in it; they are built anew, here and where the bytes are read, so that both go on the same.
std::string checkpoint(Parts& parts);

/// A world read back; its plugins are still to be restored.
struct Restored {
  std::unique_ptr<Parts> parts;
  std::vector<PluginState> plugins;
};
/// Throws CheckpointError.
Restored readCheckpoint(const std::string& bytes);

std::uint64_t stateHash(const Parts& parts);

}  // namespace kiva
