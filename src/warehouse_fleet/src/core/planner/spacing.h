// SPDX-License-Identifier: Apache-2.0
//
// Delays for floors on which a cell must be left a tick before it is entered. Paths that follow
// each other closely are driven unchanged, but later, in the order in which the plan passes each
// cell. Since no plan moves robots around in a ring, the first robot can always go on.
#pragma once

#include <vector>

#include "core/search/reservations.h"

namespace fleet {

class Spacing {
 public:
  explicit Spacing(int horizon) : horizon_(horizon) {}

  /// Returns the actions with waits inserted: for each robot as many as its path has.
  const std::vector<Action>& space(const Fleet& fleet, const Floor& floor,
                                   const Reservations& reserved);

 private:
  bool mayAct(int robot, const Fleet& fleet, const Floor& floor,
              const Reservations& reserved) const;
  bool mayEnter(int robot, const Reservations& reserved) const;
  bool mayTurn(int robot, const Fleet& fleet, const Floor& floor,
               const Reservations& reserved) const;

  const int horizon_;
  std::vector<int> done_;           ///< by robot: finished actions of its path
  std::vector<int> begun_;          ///< done_ at the begin of the tick
  std::vector<std::uint8_t> acts_;  ///< by robot: its next action is in this tick
  std::vector<Action> actions_;
};

}  // namespace fleet
