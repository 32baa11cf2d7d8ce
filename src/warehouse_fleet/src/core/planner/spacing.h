// SPDX-License-Identifier: Apache-2.0
//
// Where a cell must have been left a tick before it is entered: paths that follow each other
// closely are driven as they are, but later, in the order in which the plan passes each cell. Since
// no plan moves robots around in a ring, who comes first can always go on.
#pragma once

#include <vector>

#include "core/search/reservations.h"

namespace fleet {

class Spacing {
 public:
  explicit Spacing(int horizon) : horizon_(horizon) {}

  /// What each does with waiting put in, so many actions a robot as the paths have.
  const std::vector<Action>& space(const Fleet& fleet, const Floor& floor,
                                   const Reservations& reserved);

 private:
  bool mayAct(int robot, const Fleet& fleet, const Floor& floor,
              const Reservations& reserved) const;
  bool mayEnter(int robot, const Reservations& reserved) const;
  bool mayTurn(int robot, const Fleet& fleet, const Floor& floor,
               const Reservations& reserved) const;

  const int horizon_;
  std::vector<int> done_;           ///< actions of its path that a robot has done
  std::vector<int> begun_;          ///< the same when the tick began
  std::vector<std::uint8_t> acts_;  ///< does its next action in this tick
  std::vector<Action> actions_;
};

}  // namespace fleet
