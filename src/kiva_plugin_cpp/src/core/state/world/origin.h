// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kiva {

/// The checkpoint that a world was restored from. No part of a checkpoint.
struct Origin {
  std::uint64_t hash = 0;      ///< Of its bytes; 0 = there is none to which a way back is short.
  std::uint64_t fixtures = 0;  ///< Physics::fixtureChanges() then.
};

}  // namespace kiva
