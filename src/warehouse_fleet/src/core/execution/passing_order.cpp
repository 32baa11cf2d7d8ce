// SPDX-License-Identifier: Apache-2.0
#include "warehouse_fleet/passing_order.h"

#include <algorithm>

#include "warehouse_fleet/cell_holders.h"

namespace fleet {

void PassingOrder::clear() {
  claims_.clear();
  std::fill(next_.begin(), next_.end(), -1);
}

void PassingOrder::set(const std::vector<int>& robots, const std::vector<Course>& courses) {
  for (const Claim& claim : claims_) next_[claim.cell] = -1;
  claims_.clear();
  for (const int robot : robots) {
    for (const Step& step : courses[robot].plan) claims_.push_back({step.cell, step.tick, robot});
  }
  std::sort(claims_.begin(), claims_.end(), [](const Claim& claim, const Claim& other) {
    if (claim.cell != other.cell) return claim.cell < other.cell;
    return claim.tick != other.tick ? claim.tick < other.tick : claim.robot < other.robot;
  });
  for (std::size_t i = claims_.size(); i-- > 0;) next_[claims_[i].cell] = static_cast<int>(i);
}

int PassingOrder::first(Cell cell, const std::vector<Course>& courses) {
  int& next = next_[cell];
  while (next >= 0) {
    const Claim& claim = claims_[next];
    const std::deque<Step>& plan = courses[claim.robot].plan;
    // The robot has not made that step yet: the ticks of its plan ascend.
    if (!plan.empty() && claim.tick >= plan.front().tick) return claim.robot;
    const std::size_t following = next + 1;
    next = following < claims_.size() && claims_[following].cell == cell
               ? static_cast<int>(following)
               : -1;
  }
  return kNobody;
}

}  // namespace fleet
