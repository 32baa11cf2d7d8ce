// SPDX-License-Identifier: Apache-2.0
//
// Narrow streets of a floor whose ways lead in both directions, as between the shelves of a
// warehouse. Parallel streets are given opposite directions in turn: so robots seldom meet head on
// where they can't pass each other.
#pragma once

#include <cstdint>
#include <vector>

#include "warehouse_fleet/floor.h"

namespace fleet {

/// Returns by cell and heading whether that edge leads against the direction of a narrow street. A
/// street is a row of eight passable cells or more, two fifths of which have no passable cell on
/// either side.
std::vector<std::uint8_t> againstStreets(const Floor& floor);

}  // namespace fleet
