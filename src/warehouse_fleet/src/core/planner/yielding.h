// SPDX-License-Identifier: Apache-2.0
//
// Yielding on crowded floors: a limited number of robots pursue their goals at a time. All others,
// those without a goal included, yield: they stand, and go wherever they are pushed (Jiang et al.,
// Scaling Lifelong Multi-Agent Path Finding to More Realistic Settings, 2024, disable agents to the
// same end).
#pragma once

#include <vector>

#include "core/search/candidates.h"

namespace fleet {

class Yielding {
 public:
  /// `share`: largest number of robots that pursue their goals at a time, as a share of the
  /// passable cells. Throws FloorError unless it is above 0.
  Yielding(const Floor& floor, double share);

  /// Sets `yields` of the wishes and returns whether any robot yields: whether there are more
  /// robots than may pursue goals. A robot that pursues its goal goes on until it arrives. The next
  /// is the robot with the smallest distance less its wait (`waiting`, ticks by robot).
  bool choose(const std::vector<int>& waiting, const Candidates& candidates,
              std::vector<Wish>& wishes);

 private:
  int most_;                   ///< largest number of robots that pursue their goals at a time
  std::vector<Cell> pursued_;  ///< by robot: the goal that it pursues; kNowhere
};

}  // namespace fleet
