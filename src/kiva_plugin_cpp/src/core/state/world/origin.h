// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kiva {

/// The checkpoint that a world was restored from; itself no part of a checkpoint.
struct CheckpointOrigin {
  std::uint64_t hash = 0;  ///< Hash of its bytes; 0 = no checkpoint that returnTo() can return to.
  std::uint64_t fixtures = 0;  ///< Physics::fixtureChanges() at that time.
};

}  // namespace kiva
