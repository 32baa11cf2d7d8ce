// SPDX-License-Identifier: Apache-2.0
#include "ways.h"

namespace learning {

WayTable::WayTable(const RimmedFloor& floor) : floor_(floor) {
  for (auto& goals : to_) goals.resize(floor.size());
  for (int cell = 0; cell < floor.size(); ++cell) {
    for (int heading = 0; heading < kHeadings; ++heading) {
      const int next = floor.beside(cell, heading);
      beside_.push_back(next != kNowhere && floor.isPassable(next) ? next : kNowhere);
    }
  }
}

const Way& WayTable::to(int goal, Deck deck) {
  const Way*& way = to_[static_cast<int>(deck)][goal];
  if (!way) way = &ways_.emplace_back(measure(goal, deck));
  return *way;
}

/// Searches breadth first from the goal. A way may begin in any passable cell.
Way WayTable::measure(int goal, Deck deck) const {
  Way way(floor_.size(), kFar);
  way[goal] = 0;
  std::vector<int> wave{goal};
  wave.reserve(floor_.size());
  for (std::size_t k = 0; k < wave.size(); ++k) {
    for (int heading = 0; heading < kHeadings; ++heading) {
      const int next = beside_[kHeadings * wave[k] + heading];
      if (next == kNowhere || way[next] != kFar) continue;
      way[next] = static_cast<std::int16_t>(way[wave[k]] + 1);
      if (deck == Deck::kUnder || !floor_.isStorage(next)) wave.push_back(next);
    }
  }
  return way;
}

}  // namespace learning
