// SPDX-License-Identifier: Apache-2.0
#include "core/planner/yielding.h"

#include <algorithm>
#include <string>
#include <utility>

namespace fleet {
namespace {

constexpr int kWaitingWorth = 2;  // weight of a tick of waiting [kTickCost], as in priorities.cpp

}  // namespace

Yielding::Yielding(const Floor& floor, double share) {
  if (!(share > 0)) {
    throw FloorError("pursuing " + std::to_string(share) + "; more than 0 was expected");
  }
  int passable = 0;
  for (Cell cell = 0; cell < floor.size(); ++cell) passable += floor.isPassable(cell);
  most_ = std::max(1, static_cast<int>(share * passable));
}

bool Yielding::choose(const std::vector<int>& waiting, const Candidates& candidates,
                      std::vector<Wish>& wishes) {
  const int robots = static_cast<int>(wishes.size());
  pursued_.resize(robots, kNowhere);
  int pursuing = 0;
  std::vector<int> without;                 // a goal elsewhere
  std::vector<std::pair<int, int>> others;  // distance less wait of each, and the robot
  for (int robot = 0; robot < robots; ++robot) {
    const Wish& wish = wishes[robot];
    if (wish.goal == kNowhere || wish.goal == wish.state.cell) {
      without.push_back(robot);
    } else if (pursued_[robot] == wish.goal) {
      ++pursuing;
    } else {
      const int waited = kWaitingWorth * waiting[robot];
      others.emplace_back(candidates.distance(wish, wish.state) - waited, robot);
    }
  }
  const auto room = std::min<std::ptrdiff_t>(others.size(), std::max(0, most_ - pursuing));
  std::partial_sort(others.begin(), others.begin() + room, others.end());
  std::for_each(others.begin(), others.begin() + room,
                [&](const auto& other) { pursued_[other.second] = wishes[other.second].goal; });
  std::for_each(others.begin() + room, others.end(), [&](const auto& other) {
    pursued_[other.second] = kNowhere;
    wishes[other.second].yields = true;
  });
  const bool is_crowded = robots > most_;
  for (const int robot : without) wishes[robot].yields = is_crowded;
  return is_crowded;
}

}  // namespace fleet
