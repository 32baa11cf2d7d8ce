// SPDX-License-Identifier: Apache-2.0
//
// Squares of cells whose goals share one table: from far away, the way to a goal is the way to the
// middle of its square.
#pragma once

#include <vector>

#include "warehouse_fleet/floor.h"

namespace fleet {

class Regions {
 public:
  /// Divides a floor into squares of `side` cells.
  Regions(const Floor& floor, int side);
  /// Returns the number of squares of `side` cells that have cells on which a robot can stand.
  static int count(const Floor& floor, int side);

  int side() const { return side_; }
  int size() const { return columns_ * rows_; }
  int of(Cell cell) const { return floor_.y(cell) / side_ * columns_ + floor_.x(cell) / side_; }
  /// Returns the representative of a region on a deck: the cell nearest to the region's middle, in
  /// the deck's largest connected part and outside lanes; or kNowhere.
  Cell middle(Deck deck, int region) const { return middles_[static_cast<int>(deck)][region]; }
  /// Returns the nearest middle among a cell's region and its neighbours, or kNowhere.
  Cell nearestMiddle(Deck deck, Cell cell) const;

 private:
  void find(Deck deck);

  const Floor& floor_;
  const int side_, columns_, rows_;
  std::vector<Cell> middles_[2];
};

}  // namespace fleet
