// SPDX-License-Identifier: Apache-2.0
//
// The edges that are open in a step: those of the floor, but for cells that are closed, that hold a
// stopped robot or, to robots with a load, a storage unit.
#pragma once

#include <cstdint>
#include <vector>

#include "distance_tables.h"
#include "warehouse_fleet/fleet.h"

namespace fleet {

class Closures {
 public:
  /// Begins with every edge of the floor open. `costs` are those of Guidance.
  Closures(const Floor& floor, const std::vector<std::uint8_t>& costs);

  /// Removes the edges that lead into closed cells, and restores those of cells that are open
  /// again. Notes where a load can't be turned.
  void update(const Fleet& fleet);

  /// Returns the edges; their address stays the same.
  const Edges& edges() const { return edges_; }
  /// Returns a number that changes whenever the edges change.
  int version() const { return version_; }

 private:
  void close(Deck deck, std::vector<Cell> cells);
  void tighten(const std::vector<Cell>& cells);

  const Floor& floor_;
  Edges edges_;
  int version_ = 0;
  std::vector<Cell> closed_[2];  ///< now, by deck, sorted
  std::vector<Cell> tight_;      ///< now
};

}  // namespace fleet
