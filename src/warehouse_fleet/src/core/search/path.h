// SPDX-License-Identifier: Apache-2.0
//
// The next ticks of one robot, where it stands: the cells that it is in at each tick.
#pragma once

#include <array>

#include "core/search/operations.h"

namespace fleet {

struct Path {
  std::array<Cell, kMaxHorizon + 1> cells{};  ///< [0] is where it stands now
  Actions actions{};
  int cost = 0;
};

}  // namespace fleet
