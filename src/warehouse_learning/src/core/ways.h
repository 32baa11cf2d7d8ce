// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

#include "floor.h"

namespace learning {

/// How many cells it is to a goal, from each cell.
using Way = std::vector<std::int16_t>;
constexpr std::int16_t kFar = std::numeric_limits<std::int16_t>::max();  ///< No way leads there.

/// Ways to goals, measured when they are asked for at first.
class Ways {
 public:
  explicit Ways(const Floor& floor);

  /// With a load it keeps out of storage but at its goal. It stays where it is.
  const Way& to(int goal, Deck deck);

 private:
  Way measure(int goal, Deck deck) const;

  const Floor& floor_;
  std::vector<int> beside_;  // by cell and heading; kNowhere if one can't go there
  std::deque<Way> ways_;
  std::array<std::vector<const Way*>, 2> to_;  // by deck, by goal
};

}  // namespace learning
