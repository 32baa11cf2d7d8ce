// SPDX-License-Identifier: Apache-2.0
//
// Dead ends, and pockets behind a passage: cells that a single cell connects to the rest. A robot
// with a goal in one where others stand would push them to its end and wait for ever. So the robots
// in its way come out first, the outermost first, past the robot, which makes way for them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/floor/distance_tables.h"
#include "core/search/candidates.h"

namespace fleet {

class DeadEnds {
 public:
  explicit DeadEnds(const Floor& floor);

  /// Serves one robot at each entrance, of those with goals in dead ends. While others are in its
  /// way, the outermost of them gets an urgent goal outside and the robot yields; then the way in
  /// is kept for the robot. Overwrites their wishes.
  void empty(DistanceTables& tables, Candidates& candidates, std::vector<Wish>& wishes);

 private:
  void serve(int robot, DistanceTables& tables, Candidates& candidates, std::vector<Wish>& wishes);
  Cell entrance(Cell cell) const;
  Cell roomiest(Cell gate, const std::vector<std::uint8_t>& is_inside) const;

  const Floor& floor_;
  std::vector<Cell> out_;      ///< by cell: the next on the way out; kNowhere outside dead ends
  std::vector<Cell> outside_;  ///< by entrance: a cell beyond, as goal of robots that come out
  std::vector<int> served_;    ///< by entrance: the robot that drives in, or -1
  std::vector<int> standing_;  ///< by cell: the robot there, or -1
};

}  // namespace fleet
