// SPDX-License-Identifier: Apache-2.0
//
// Robots without loads, each sent from cell to cell; the validator checks every plan before it is
// driven.
#pragma once

#include <memory>

#include "planner_shift.h"

namespace fleet::test {

/// Walls here and there, two dead ends among them.
inline const std::vector<std::string> kScattered = {
    "............", "..#....#...#", ".....#......", ".#........#.", "....#..#....", "..#........#",
    ".......#....", ".#...#....#.", "...#........", "......#.#..#", ".#......#...", "....#.....#.",
};

/// Robots pass their goals without a stop.
inline EpibtOptions passing() {
  EpibtOptions options;
  options.goals_are_stops = false;
  return options;
}

/// Robots that each go to one random cell after the other.
class Errands {
 public:
  Errands(const std::vector<std::string>& rows, int robots, const Rules& rules,
          const EpibtOptions& options = passing())
      : floor(drawn(rows)), rules_(rules), free_(cellsOf(rows, '.')), planner_(makeEpibt(options)) {
    std::vector<Cell> cells = free_;
    std::shuffle(cells.begin(), cells.end(), random_);
    fleet.cell.assign(cells.begin(), cells.begin() + robots);
    fleet.heading.assign(robots, 0);
    for (int robot = 0; robot < robots; ++robot) fleet.goal.push_back(anyFree());
    since.assign(robots, 0);
    planner_->start(floor, rules, 1);
  }

  /// Drives for `ticks`; returns the number of goals that were reached.
  int run(int ticks, const Budget& budget = {0, 0}) {
    int arrivals = 0;
    for (int tick = 0; tick < ticks; ++tick) {
      planner_->plan(fleet, budget, plan_);
      for (const Violation& violation : validate(floor, fleet, plan_, rules_, 1)) {
        ADD_FAILURE() << describe(violation, floor);
        return 0;
      }
      for (int robot = 0; robot < fleet.size(); ++robot) arrivals += drive(robot);
    }
    return arrivals;
  }

  const Floor floor;
  Fleet fleet;
  std::vector<int> since;  ///< by robot: ticks since it got its goal

 private:
  Cell anyFree() { return free_[random_() % free_.size()]; }

  bool drive(int robot) {
    const GridPose before{fleet.cell[robot], fleet.heading[robot]};
    const bool is_stopped = fleet.isStopped(robot);
    const GridPose state = is_stopped ? before : after(floor, before, plan_.at(robot, 0));
    fleet.cell[robot] = state.cell;
    fleet.heading[robot] = state.heading;
    ++since[robot];
    if (state.cell != fleet.goal[robot]) return false;
    fleet.goal[robot] = anyFree();
    since[robot] = 0;
    return true;
  }

  const Rules rules_;
  const std::vector<Cell> free_;
  std::mt19937_64 random_{3};
  std::unique_ptr<Planner> planner_;
  Plan plan_;
};

}  // namespace fleet::test
