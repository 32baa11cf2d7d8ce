// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace kiva {

/// An area on which robots are charged, in world [m].
struct Charger {
  double min_x = 0, max_x = 0, min_y = 0, max_y = 0;
};

/// The chargers of a world, as its floor markings show them.
struct Chargers {
  std::vector<Charger> areas;
  std::uint64_t models_revision = ~0ull;  ///< The models' revision when they were found.
};

}  // namespace kiva
