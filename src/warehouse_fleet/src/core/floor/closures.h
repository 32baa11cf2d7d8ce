// SPDX-License-Identifier: Apache-2.0
//
// The edges that are open in a step. Closed cells, cells of stopped robots and, for loaded robots,
// cells of storage units are left out, as are the edges that lead into a zone from outside. Where
// such cells stay closed, the one-way streets that they cut become two-way (severed.h).
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
  /// Starts with every edge of the floor open. `costs` are those of Guidance.
  Closures(const Floor& floor, const std::vector<std::uint8_t>& costs);

  /// Removes edges into closed cells, restores edges into reopened ones, and marks cells where a
  /// load can't turn. Called once a tick.
  void update(const Fleet& fleet);

  /// Returns the edges, at a fixed address.
  const Edges& edges() const { return edges_; }
  /// Returns a number that changes whenever the edges change.
  int version() const { return version_; }

 private:
  /// Closed cells, sorted.
  struct Closed {
    std::vector<Cell> cells;    ///< closed to all robots
    std::vector<Cell> zone;     ///< closed to robots outside of them
    std::vector<Cell> units;    ///< closed to loaded robots
    std::vector<Cell> waiting;  ///< units in lanes behind which a loaded robot waits
    bool operator==(const Closed& other) const {
      return cells == other.cells && zone == other.zone && units == other.units &&
             waiting == other.waiting;
    }
  };

  Closed now(const Fleet& fleet) const;
  bool isWaitedFor(Cell unit, const Fleet& fleet) const;
  Closed lasting(const Closed& now);
  void open();
  void close();
  void set(Deck deck, const std::vector<Cell>& cells, bool is_open);
  void fence(Deck deck, const std::vector<Cell>& zone);
  void comeFromBeyond(Cell unit);
  void leadBack(Deck deck, const std::vector<BackEdge>& edges);
  void tighten(const std::vector<Cell>& cells);

  const Floor& floor_;
  Edges edges_;
  int version_ = 0;
  int tick_ = 0;
  std::map<Cell, int> since_;  ///< tick at which each cell was closed
  Closed closed_;              ///< in this tick
  Closed lasting_;             ///< cells closed for long
  std::vector<Cell> tight_;    ///< in this tick
};

}  // namespace fleet
