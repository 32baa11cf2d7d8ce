// SPDX-License-Identifier: Apache-2.0
//
// The order in which robots choose their paths in a step, and the weight of each robot's cost.
#pragma once

#include <vector>

#include "core/search/candidates.h"
#include "core/search/making_way.h"

namespace fleet {

class Priorities {
 public:
  /// Ranks the robots by distance to their goals less their wait: `waiting` counts each robot's
  /// ticks since it got its goal or reached it. Robots that were directed to make way come first.
  void assign(const std::vector<Wish>& wishes, const std::vector<int>& waiting,
              const Candidates& candidates, const MakingWay& way);

  /// Returns the robots in the order in which they choose.
  const std::vector<int>& order() const { return order_; }
  /// Returns a robot's rank in that order, from 0.
  int rank(int robot) const { return rank_[robot]; }
  /// Returns the weight of a robot's cost in the cost of all robots.
  int weight(int robot) const { return weight_[robot]; }

 private:
  std::vector<int> order_, rank_, weight_;
};

}  // namespace fleet
