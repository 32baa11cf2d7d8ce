// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

#include "floor.h"

namespace learning {

/// The distance to a goal from each cell [cells].
using Way = std::vector<std::int16_t>;
constexpr std::int16_t kFar = std::numeric_limits<std::int16_t>::max();  ///< There is no way.

/// Ways to goals, computed on demand.
class WayTable {
 public:
  explicit WayTable(const RimmedFloor& floor);

  /// Returns the way to a goal, at a fixed address. On the aisles' deck it avoids storage places
  /// except the goal.
  const Way& to(int goal, Deck deck);

 private:
  Way measure(int goal, Deck deck) const;

  const RimmedFloor& floor_;
  std::vector<int> beside_;  // by cell and heading; kNowhere where there is no passage
  std::deque<Way> ways_;
  std::array<std::vector<const Way*>, 2> to_;  // by deck, by goal
};

}  // namespace learning
