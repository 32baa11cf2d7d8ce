// SPDX-License-Identifier: Apache-2.0
//
// Squares of cells whose goals share one table: from far away the way to each of them is the way to
// the square's middle.
#pragma once

#include <vector>

#include "warehouse_fleet/floor.h"

namespace fleet {

class Regions {
 public:
  /// Squares of `side` cells.
  Regions(const Floor& floor, int side);
  /// Returns how many squares of `side` cells have cells on which a robot can stand.
  static int count(const Floor& floor, int side);

  int side() const { return side_; }
  int size() const { return columns_ * rows_; }
  int of(Cell cell) const { return floor_.y(cell) / side_ * columns_ + floor_.x(cell) / side_; }
  /// Returns the cell that stands for a region on a deck: the nearest to its middle of the deck's
  /// largest connected part, no lane among them; kNowhere.
  Cell middle(Deck deck, int region) const { return middles_[static_cast<int>(deck)][region]; }
  /// Returns the nearest of the middles of a cell's region and of those around it; kNowhere.
  Cell nearestMiddle(Deck deck, Cell cell) const;

 private:
  void find(Deck deck);

  const Floor& floor_;
  const int side_, columns_, rows_;
  std::vector<Cell> middles_[2];
};

}  // namespace fleet
