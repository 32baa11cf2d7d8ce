// SPDX-License-Identifier: Apache-2.0
#include "core/planner/spacing.h"

namespace fleet {

const std::vector<Action>& Spacing::space(const Fleet& fleet, const Floor& floor,
                                          const Reservations& reserved) {
  done_.assign(fleet.size(), 0);
  actions_.assign(fleet.size() * horizon_, Action::kWait);
  for (int tick = 0; tick < horizon_; ++tick) {
    begun_ = done_;
    acts_.assign(fleet.size(), 0);
    for (int robot = 0; robot < fleet.size(); ++robot) {
      if (begun_[robot] == horizon_ || !mayAct(robot, fleet, floor, reserved)) continue;
      acts_[robot] = 1;
      actions_[robot * horizon_ + tick] = reserved.path(robot).actions[done_[robot]++];
    }
  }
  return actions_;
}

bool Spacing::mayAct(int robot, const Fleet& fleet, const Floor& floor,
                     const Reservations& reserved) const {
  const Action action = reserved.path(robot).actions[begun_[robot]];
  if (action == Action::kForward) return mayEnter(robot, reserved);
  return quarters(action) == 0 || !fleet.isLoaded(robot) || mayTurn(robot, fleet, floor, reserved);
}

/// Returns whether all robots that pass the cell before it had left when the tick began.
bool Spacing::mayEnter(int robot, const Reservations& reserved) const {
  const int entered = begun_[robot] + 1;
  const Cell cell = reserved.path(robot).cells[entered];
  for (int tick = 0; tick < entered; ++tick) {
    const int other = reserved.who(cell, tick);
    if (other == Reservations::kNobody || other == robot) continue;
    if (begun_[other] <= tick) return false;
  }
  return true;
}

/// Returns whether no loaded robot beside it turns in this tick.
bool Spacing::mayTurn(int robot, const Fleet& fleet, const Floor& floor,
                      const Reservations& reserved) const {
  const Cell cell = reserved.path(robot).cells[begun_[robot]];
  for (int other = 0; other < fleet.size(); ++other) {
    if (other == robot || !fleet.isLoaded(other) || !acts_[other]) continue;
    const Path& path = reserved.path(other);
    if (quarters(path.actions[begun_[other]]) == 0) continue;
    for (int heading = 0; heading < kHeadings; ++heading) {
      if (floor.beside(path.cells[begun_[other]], heading) == cell) return false;
    }
  }
  return true;
}

}  // namespace fleet
