// SPDX-License-Identifier: Apache-2.0
//
// Checks whether a plan can be driven. The validator depends on the floor and the rules, and on no
// planner.
#pragma once

#include <string>
#include <vector>

#include "warehouse_fleet/fleet.h"

namespace fleet {

struct Violation {
  enum class Kind : std::uint8_t {
    kWall,        ///< drives where its deck has no edge, or into a closed cell
    kVertex,      ///< two robots in one cell
    kSwap,        ///< two robots exchange their cells
    kRing,        ///< several robots move around in a ring
    kFollowing,   ///< enters a cell in the tick in which another leaves it
    kTurning,     ///< two loaded robots side by side turn
    kCommitment,  ///< deviates from a committed action
    kStopped,     ///< a stopped robot moves
  };
  Kind kind;
  int tick;                 ///< 0 for the first action
  std::vector<int> robots;  ///< indices of the robots involved
  Cell cell;                ///< cell of the violation
};

/// Returns all violations in the first `ticks` of a plan (-1: in all of it), for a fleet that
/// passes check(). Throws FloorError unless the plan has one action a robot and tick.
std::vector<Violation> validate(const Floor& floor, const Fleet& fleet, const Plan& plan,
                                const Rules& rules, int ticks = -1);

/// Returns a violation as a sentence, with the names of robots, or "robot <index>".
std::string describe(const Violation& violation, const Floor& floor,
                     const std::vector<std::string>& names = {});

}  // namespace fleet
