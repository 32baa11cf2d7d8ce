// SPDX-License-Identifier: Apache-2.0
//
// Dead ends, and pockets behind a passage: cells that one can't leave but by a single cell before
// them. A robot that is to go into one where others stand would push them to its end and stand
// before them for ever; so those in its way come out first, the outermost first, past the robot,
// which makes way for them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/floor/distance_tables.h"
#include "core/search/candidates.h"

namespace fleet {

class DeadEnds {
 public:
  explicit DeadEnds(const Floor& floor);

  /// Sees to the dead ends in which robots have goals that they pursue, one robot an entrance.
  /// While others are in its way, the outermost gets an urgent goal outside and the robot yields;
  /// then the way in is kept for it. Overwrites their wishes.
  void empty(DistanceTables& tables, Candidates& candidates, std::vector<Wish>& wishes);

 private:
  void serve(int robot, DistanceTables& tables, Candidates& candidates, std::vector<Wish>& wishes);
  Cell entrance(Cell cell) const;
  Cell roomiest(Cell gate, const std::vector<std::uint8_t>& is_inside) const;

  const Floor& floor_;
  std::vector<Cell> out_;      ///< by cell: the next on the way out; kNowhere: in no dead end
  std::vector<Cell> outside_;  ///< by entrance: a cell beyond, for those that come out
  std::vector<int> served_;    ///< by entrance: the robot that goes in, or -1
  std::vector<int> standing_;  ///< by cell: who, or -1
};

}  // namespace fleet
