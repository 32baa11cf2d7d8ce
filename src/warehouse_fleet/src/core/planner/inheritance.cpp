// SPDX-License-Identifier: Apache-2.0
#include "core/planner/inheritance.h"

#include <algorithm>
#include <numeric>

namespace fleet {

void Inheritance::begin(const Fleet& fleet) {
  constexpr int kWorth = 500;  // robots that justify a thread
  const int robots = fleet.size();
  if (robots < static_cast<int>(begins_.size())) begins_.clear();
  begins_.resize(robots);
  rests_.resize(robots);
  is_as_planned_.resize(robots);
  threads_.share(robots, kWorth, [&](int robot, int) { findRest(robot); });
  reserved_.begin(fleet);
  const auto& each = is_as_planned_;
  if (std::find(each.begin(), each.end(), 0) != each.end()) return resume();
  for (int robot = 0; robot < robots; ++robot) reserved_.place(robot, rests_[robot]);
}

void Inheritance::findRest(int robot) {
  const Wish& wish = wishes_[robot];
  const Begin& begin = begins_[robot];
  bool is_as_planned = false, is_known = false;
  if (begin.state.cell != kNowhere && begin.deck == wish.deck) {
    rests_[robot] = candidates_.rest(reserved_.path(robot), begin.state, wish, is_as_planned);
    is_known = candidates_.canDrive(rests_[robot], wish);
  }
  if (!is_known) rests_[robot] = candidates_.standing(wish);
  is_as_planned_[robot] = static_cast<std::uint8_t>(is_known && is_as_planned);
}

/// Makes all robots stand except the committed ones; a robot that blocks no other resumes its path.
void Inheritance::resume() {
  const int robots = static_cast<int>(rests_.size());
  for (const bool is_committed : {true, false}) {
    for (int robot = 0; robot < robots; ++robot) {
      if ((wishes_[robot].committed > 0) != is_committed) continue;
      const Path standing = candidates_.standing(wishes_[robot]);
      const bool can_stand = reserved_.conflict(robot, standing) == Reservations::kNobody;
      reserved_.place(robot, can_stand ? standing : rests_[robot]);
    }
  }
  std::vector<int> waiting(robots), still;
  std::iota(waiting.begin(), waiting.end(), 0);
  do {
    still.clear();
    for (const int robot : waiting) {
      const Path standing = reserved_.path(robot);
      reserved_.remove(robot);
      const bool is_free = reserved_.conflict(robot, rests_[robot]) == Reservations::kNobody;
      reserved_.place(robot, is_free ? rests_[robot] : standing);
      if (!is_free) still.push_back(robot);
    }
    waiting.swap(still);
  } while (waiting.size() < still.size());
}

void Inheritance::remember() {
  for (std::size_t robot = 0; robot < begins_.size(); ++robot) {
    begins_[robot] = {wishes_[robot].state, wishes_[robot].deck};
  }
}

}  // namespace fleet
