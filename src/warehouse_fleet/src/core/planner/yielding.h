// SPDX-License-Identifier: Apache-2.0
//
// On a floor so full that robots are in each other's way wherever they go, only some of them pursue
// their goals at a time; all others yield: they stand, and go wherever they are pushed (Jiang et
// al., Scaling Lifelong Multi-Agent Path Finding to More Realistic Settings, 2024, disable agents
// to the same end).
#pragma once

#include <vector>

#include "core/search/candidates.h"

namespace fleet {

class Yielding {
 public:
  /// `share`: how many robots may pursue their goals at a time, over the passable cells. Throws
  /// FloorError if it is not more than 0.
  Yielding(const Floor& floor, double share);

  /// Sets `yields` of the wishes and returns whether any robot yields. A robot that pursues its
  /// goal goes on until it is there; the place it leaves is given to the robot with least to go,
  /// less what it has waited (`waiting`, ticks by robot).
  bool choose(const std::vector<int>& waiting, const Candidates& candidates,
              std::vector<Wish>& wishes);

 private:
  int most_;                   ///< robots that pursue their goals at a time
  std::vector<Cell> pursued_;  ///< by robot: the goal that it pursues; kNowhere
};

}  // namespace fleet
