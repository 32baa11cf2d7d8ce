// SPDX-License-Identifier: Apache-2.0
#include "warehouse_fleet/fleet.h"

#include <unordered_map>

namespace fleet {
namespace {

/// Checks one fleet; errors have its robots' names.
class Check {
 public:
  Check(const Floor& floor, const Fleet& fleet, const std::vector<std::string>& names)
      : floor_(floor), fleet_(fleet), names_(names) {}

  void lengths() const {
    length(fleet_.heading.size(), "heading", false);
    length(fleet_.goal.size(), "goal", false);
    length(fleet_.loaded.size(), "loaded", true);
    length(fleet_.home.size(), "home", true);
    length(fleet_.stopped.size(), "stopped", true);
    const std::size_t committed = fleet_.cell.size() * fleet_.committed_ticks;
    if (fleet_.committed.size() != committed) {
      throw FloorError("committed has " + std::to_string(fleet_.committed.size()) +
                       " elements; robots * committed_ticks = " + std::to_string(committed) +
                       " were expected");
    }
  }

  void robots() const {
    std::unordered_map<Cell, int> standing;
    for (int robot = 0; robot < fleet_.size(); ++robot) {
      const Cell cell = fleet_.cell[robot];
      place(robot, cell, "stands at", false);
      place(robot, fleet_.goal[robot], "has the goal", true);
      place(robot, fleet_.homeOf(robot), "has the home", true);
      if (fleet_.heading[robot] >= kHeadings) {
        throw FloorError(name(robot) + " has heading " + std::to_string(fleet_.heading[robot]) +
                         "; 0 to 3 was expected");
      }
      const auto [other, is_new] = standing.emplace(cell, robot);
      if (!is_new) {
        throw FloorError(name(other->second) + " and " + name(robot) + " both stand at " +
                         floor_.name(cell));
      }
    }
    cells(fleet_.closed, "closed: ");
    cells(fleet_.zone, "zone: ");
    cells(fleet_.units, "units: ");
    cells(fleet_.tight, "tight: ");
  }

 private:
  void length(std::size_t is, const char* field, bool may_be_empty) const {
    if (is == fleet_.cell.size() || (may_be_empty && is == 0)) return;
    throw FloorError(std::string(field) + " has " + std::to_string(is) +
                     " elements; one a robot, " + std::to_string(fleet_.cell.size()) +
                     ", was expected");
  }

  void cells(const std::vector<Cell>& cells, const char* what) const {
    for (const Cell cell : cells) {
      if (!floor_.has(cell)) throw FloorError(what + floor_.name(cell));
    }
  }

  void place(int robot, Cell cell, const char* what, bool or_nowhere) const {
    if (or_nowhere && cell == kNowhere) return;
    if (floor_.has(cell) && floor_.isPassable(cell)) return;
    throw FloorError(name(robot) + " " + what + " " + floor_.name(cell) +
                     ", where no robot can stand");
  }

  std::string name(int robot) const {
    return names_.empty() ? "robot " + std::to_string(robot) : names_.at(robot);
  }

  const Floor& floor_;
  const Fleet& fleet_;
  const std::vector<std::string>& names_;
};

}  // namespace

int Fleet::commitments(int robot) const {
  int ticks = 0;
  while (ticks < committed_ticks && committed[robot * committed_ticks + ticks] != kFree) ++ticks;
  return ticks;
}

GridPose after(const Floor& floor, GridPose state, Action action) {
  if (action == Action::kForward) return {floor.beside(state.cell, state.heading), state.heading};
  return {state.cell, turned(state.heading, quarters(action))};
}

void check(const Floor& floor, const Fleet& fleet, const std::vector<std::string>& names) {
  const Check check(floor, fleet, names);
  check.lengths();
  check.robots();
}

}  // namespace fleet
