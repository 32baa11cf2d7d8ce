// SPDX-License-Identifier: Apache-2.0
//
// Checks whether a plan can be driven. The validator knows the floor and the rules, and nothing of
// how planners work.
#pragma once

#include <string>
#include <vector>

#include "warehouse_fleet/fleet.h"

namespace fleet {

struct Violation {
  enum class Kind : std::uint8_t {
    kWall,        ///< drives where its deck has no edge, or into a closed cell
    kVertex,      ///< two in one cell
    kSwap,        ///< two that exchange their cells
    kRing,        ///< several that move around in a ring
    kFollowing,   ///< enters a cell in the tick in which another leaves it
    kTurning,     ///< two loaded robots side by side turn
    kCommitment,  ///< does other than it is committed to
    kStopped,     ///< one that is stopped moves
  };
  Kind kind;
  int tick;                 ///< 0 for the first action
  std::vector<int> robots;  ///< who
  Cell cell;                ///< where
};

/// Returns all violations in the first `ticks` of a plan (-1: in all of it), for a fleet that
/// passes check(). Throws FloorError if the plan does not have one action a robot and tick.
std::vector<Violation> validate(const Floor& floor, const Fleet& fleet, const Plan& plan,
                                const Rules& rules, int ticks = -1);

/// Returns a violation as a sentence, with the names of robots, or "robot <index>".
std::string describe(const Violation& violation, const Floor& floor,
                     const std::vector<std::string>& names = {});

}  // namespace fleet
