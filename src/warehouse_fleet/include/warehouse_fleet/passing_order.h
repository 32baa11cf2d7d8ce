// SPDX-License-Identifier: Apache-2.0
//
// The order in which robots pass each cell, by the plan.
#pragma once

#include <vector>

#include "warehouse_fleet/course.h"

namespace fleet {

class PassingOrder {
 public:
  explicit PassingOrder(Cell cells) : next_(cells, -1) {}

  void clear();
  /// Sets the order by the plans of these robots.
  void set(const std::vector<int>& robots, const std::vector<Course>& courses);
  /// Returns the next robot to pass a cell among those whose plan still leads there, or kNobody.
  int first(Cell cell, const std::vector<Course>& courses);

 private:
  struct Claim {
    Cell cell;
    int tick, robot;
  };
  std::vector<Claim> claims_;  ///< by cell and tick
  std::vector<int> next_;      ///< by cell: the first claim that may still hold, or -1
};

}  // namespace fleet
