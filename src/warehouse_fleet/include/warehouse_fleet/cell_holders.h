// SPDX-License-Identifier: Apache-2.0
//
// The robot that holds each cell, and the closed cells. At most one robot holds a cell, from before
// it may enter until it and its load have left.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "warehouse_fleet/floor.h"

namespace fleet {

constexpr int kNobody = -1;  ///< No robot.

class CellHolders {
 public:
  explicit CellHolders(const Floor& floor);

  /// Frees all cells. Closed cells stay closed.
  void clear();
  void hold(Cell cell, int robot) { holder_[cell] = robot; }
  /// Frees a cell if that robot holds it.
  void free(Cell cell, int robot);
  /// Returns the robot that holds a cell, or kNobody.
  int holder(Cell cell) const { return holder_[cell]; }
  bool isFreeFor(Cell cell, int robot) const {
    return holder_[cell] == kNobody || holder_[cell] == robot;
  }

  /// Closes a cell until `until` [s]; ignores a cell off the floor.
  void close(Cell cell, double until);
  bool isClosed(Cell cell, double now) const { return closed_until_[cell] > now; }
  /// Returns whether a cell is closed by close().
  bool isClosing(double now) const;
  /// Closes cells where people are or are about to be, in place of the previous zone. A robot
  /// inside drives on along its released cells, and out.
  void setZone(std::vector<Cell> cells);
  /// Closes cells for robots outside of them, in place of those of the call before. Robots inside
  /// drive on within, and out.
  void setClosedZone(std::vector<Cell> cells);
  const std::vector<Cell>& closedZone() const { return closed_zone_; }
  bool isInClosedZone(Cell cell) const { return is_in_closed_zone_[cell] != 0; }
  /// Returns whether a robot in the cell `from` must not enter a cell of a zone.
  bool isFenced(Cell from, Cell cell) const {
    return (is_in_zone_[cell] && !is_in_zone_[from]) ||
           (is_in_closed_zone_[cell] && !is_in_closed_zone_[from]);
  }
  /// Returns the cells of the zone and those closed by close(), unordered.
  std::vector<Cell> closed(double now) const;

  /// Sets the aisle cells that units occupy: loaded robots can't pass.
  void setUnits(std::vector<Cell> cells) { units_ = std::move(cells); }
  const std::vector<Cell>& units() const { return units_; }

 private:
  void replace(std::vector<Cell> cells, std::vector<Cell>& zone,
               std::vector<std::uint8_t>& is_in) const;

  const Floor& floor_;
  std::vector<int> holder_;           ///< by cell
  std::vector<double> closed_until_;  ///< by cell [s]
  std::vector<Cell> closing_;         ///< cells that are or were closed by close()
  std::vector<Cell> zone_;
  std::vector<std::uint8_t> is_in_zone_;  ///< by cell
  std::vector<Cell> closed_zone_;
  std::vector<std::uint8_t> is_in_closed_zone_;  ///< by cell
  std::vector<Cell> units_;
};

}  // namespace fleet
