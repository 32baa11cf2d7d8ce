// SPDX-License-Identifier: Apache-2.0
//
// The order in which robots choose their paths in a step, and how much each robot's cost counts.
#pragma once

#include <vector>

#include "core/search/candidates.h"
#include "core/search/making_way.h"

namespace fleet {

class Priorities {
 public:
  /// Ranks the robots by what they have still to go, less what they have waited: `waiting` counts
  /// each robot's ticks since it got its goal or reached it. Robots that were told to make way come
  /// first.
  void assign(const std::vector<Wish>& wishes, const std::vector<int>& waiting,
              const Candidates& candidates, const MakingWay& way);

  /// Returns the robots, the first to choose first.
  const std::vector<int>& order() const { return order_; }
  /// Returns a robot's place in that order, from 0.
  int rank(int robot) const { return rank_[robot]; }
  /// Returns by what a robot's cost is multiplied in that of all robots.
  int weight(int robot) const { return weight_[robot]; }

 private:
  std::vector<int> order_, rank_, weight_;
};

}  // namespace fleet
