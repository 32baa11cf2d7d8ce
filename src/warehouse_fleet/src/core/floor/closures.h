// SPDX-License-Identifier: Apache-2.0
//
// The edges that are open in a step: those of the floor, but for cells that are closed, that hold a
// stopped robot or, to robots with a load, a storage unit. Where such cells stay closed, one-way
// streets that they cut lead back as well (severed.h).
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "core/floor/distance_tables.h"
#include "core/floor/severed.h"
#include "warehouse_fleet/fleet.h"

namespace fleet {

class Closures {
 public:
  /// Begins with every edge of the floor open. `costs` are those of Guidance.
  Closures(const Floor& floor, const std::vector<std::uint8_t>& costs);

  /// Removes the edges that lead into closed cells, and restores those of cells that are open
  /// again. Notes where a load can't be turned. Called once a tick.
  void update(const Fleet& fleet);

  /// Returns the edges; their address stays the same.
  const Edges& edges() const { return edges_; }
  /// Returns a number that changes whenever the edges change.
  int version() const { return version_; }

 private:
  /// Cells that are closed; all sorted.
  struct Closed {
    std::vector<Cell> cells;    ///< to all robots
    std::vector<Cell> units;    ///< to loaded ones
    std::vector<Cell> waiting;  ///< units in lanes behind which a loaded robot waits
    bool operator==(const Closed& other) const {
      return cells == other.cells && units == other.units && waiting == other.waiting;
    }
  };

  Closed now(const Fleet& fleet) const;
  bool isWaitedFor(Cell unit, const Fleet& fleet) const;
  Closed lasting(const Closed& now);
  void open();
  void close();
  void set(Deck deck, const std::vector<Cell>& cells, bool is_open);
  void comeFromBeyond(Cell unit);
  void leadBack(Deck deck, const std::vector<BackEdge>& edges);
  void tighten(const std::vector<Cell>& cells);

  const Floor& floor_;
  Edges edges_;
  int version_ = 0;
  int tick_ = 0;
  std::map<Cell, int> since_;  ///< tick from which on each cell has been closed
  Closed closed_;              ///< now
  Closed lasting_;             ///< those of them that have been closed for long
  std::vector<Cell> tight_;    ///< now
};

}  // namespace fleet
