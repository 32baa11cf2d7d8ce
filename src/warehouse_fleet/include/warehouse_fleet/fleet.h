// SPDX-License-Identifier: Apache-2.0
//
// The input and output of a planner at a step: a fleet as arrays, one element a robot, and a plan.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "warehouse_fleet/floor.h"

namespace fleet {

/// The action of a robot in one tick: the time of a cell at top speed, or of a quarter turn.
enum class Action : std::uint8_t {
  kWait = 0,
  kForward = 1,
  kTurnPositive = 2,  ///< from +x towards +y
  kTurnNegative = 3,
};

/// Returns the quarter turns by which an action changes the heading.
constexpr int quarters(Action action) {
  return action == Action::kTurnPositive ? 1 : action == Action::kTurnNegative ? -1 : 0;
}

/// The movements that may happen in the same tick.
struct Rules {
  /// A robot may enter a cell in the tick in which another leaves it; otherwise one tick later.
  bool following = true;
  /// Robots that follow each other in a ring may all move in one tick.
  bool rings = false;
  /// Two loaded robots side by side may turn in one tick, since execution keeps them apart.
  bool turning = false;
};

/// The fleet at a planning step. `cell`, `heading` and `goal` have an element for each robot. So
/// have the other arrays, unless they are empty and their default holds.
struct Fleet {
  std::vector<Cell> cell;
  std::vector<Heading> heading;
  std::vector<Cell> goal;  ///< kNowhere: no goal; the robot stands where it blocks no other
  std::vector<std::uint8_t> loaded;   ///< 1: drives on the aisles (default: none)
  std::vector<Cell> home;             ///< a storage place that it may enter loaded (default: none)
  std::vector<std::uint8_t> stopped;  ///< 1: stays where it is in any case (default: none)
  /// The committed actions of each robot, in order, `committed_ticks` a robot. A row has kFree from
  /// the tick at which its robot is free (default: all are free).
  std::vector<std::uint8_t> committed;
  int committed_ticks = 0;
  std::vector<Cell> closed;  ///< cells that no robot may enter now
  std::vector<Cell> zone;    ///< cells that robots inside leave, and no other enters
  std::vector<Cell> units;   ///< aisle cells with a unit: loaded robots can't pass
  std::vector<Cell> tight;   ///< cells where a load has no room to turn, but may pass

  static constexpr std::uint8_t kFree = 0xff;

  int size() const { return static_cast<int>(cell.size()); }
  bool isLoaded(int robot) const { return !loaded.empty() && loaded[robot]; }
  bool isStopped(int robot) const { return !stopped.empty() && stopped[robot]; }
  Cell homeOf(int robot) const { return home.empty() ? kNowhere : home[robot]; }
  Deck deck(int robot) const { return isLoaded(robot) ? Deck::kAisles : Deck::kUnder; }
  /// Returns the number of a robot's committed actions.
  int commitments(int robot) const;
  Action commitment(int robot, int tick) const {
    return static_cast<Action>(committed[robot * committed_ticks + tick]);
  }
};

/// A plan: `horizon` actions a robot, robot by robot. Robots that keep to it do not collide.
struct Plan {
  int horizon = 0;  ///< ticks
  std::vector<Action> actions;

  Action at(int robot, int tick) const { return actions[robot * horizon + tick]; }
};

/// The cell and heading of a robot.
struct GridPose {
  Cell cell = kNowhere;
  Heading heading = 0;
  bool operator==(const GridPose& other) const {
    return cell == other.cell && heading == other.heading;
  }
};
/// Returns the pose after `action` on an open floor, allowed or not; kNowhere beyond its edge.
GridPose after(const Floor& floor, GridPose state, Action action);

/// Throws FloorError if a robot stands in a wall, two stand in one cell, a goal is off the floor,
/// or lengths differ. The message has `names`, or "robot <index>".
void check(const Floor& floor, const Fleet& fleet, const std::vector<std::string>& names = {});

}  // namespace fleet
