// SPDX-License-Identifier: Apache-2.0
#include "core/planner/dead_ends.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "core/floor/pockets.h"

namespace fleet {
namespace {

constexpr int kNear = 6;  // distance of a robot from the entrance at which others come out [cells]

constexpr int kMostCells =
    24;  // largest dead end that is emptied: several robots may enter a larger one

}  // namespace

/// The exit of a pocket is the shortest way out of it.
DeadEnds::DeadEnds(const Floor& floor)
    : floor_(floor),
      out_(floor.size(), kNowhere),
      outside_(floor.size(), kNowhere),
      served_(floor.size(), -1),
      standing_(floor.size(), -1) {
  const std::vector<std::uint8_t> is_inside = pockets(floor, kMostCells);
  std::vector<Cell> cells;
  for (Cell cell = 0; cell < floor.size(); ++cell) {
    if (floor.isPassable(cell) && !is_inside[cell]) cells.push_back(cell);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (const Cell next : neighbours(floor, cells[i])) {
      if (!is_inside[next] || out_[next] != kNowhere) continue;
      out_[next] = cells[i];
      cells.push_back(next);
      if (!is_inside[cells[i]]) outside_[cells[i]] = roomiest(cells[i], is_inside);
    }
  }
}

/// Returns the neighbour of an entrance, outside, that has the most neighbours; kNowhere if there
/// is none.
Cell DeadEnds::roomiest(Cell gate, const std::vector<std::uint8_t>& is_inside) const {
  Cell best = kNowhere;
  std::ptrdiff_t most = -1;
  for (const Cell cell : neighbours(floor_, gate)) {
    const std::vector<Cell> around = neighbours(floor_, cell);
    const auto open =
        std::count_if(around.begin(), around.end(), [&](Cell cell) { return !is_inside[cell]; });
    if (is_inside[cell] || open <= most) continue;
    most = open;
    best = cell;
  }
  return best;
}

/// Returns the cell before a dead end.
Cell DeadEnds::entrance(Cell cell) const {
  while (out_[cell] != kNowhere) cell = out_[cell];
  return cell;
}

void DeadEnds::empty(DistanceTables& tables, Candidates& candidates, std::vector<Wish>& wishes) {
  std::vector<int> entering(floor_.size(), -1);
  standing_.assign(floor_.size(), -1);
  const int robots = static_cast<int>(wishes.size());
  for (int robot = 0; robot < robots; ++robot) {
    const Wish& wish = wishes[robot];
    standing_[wish.state.cell] = robot;
    if (wish.yields || wish.goal == kNowhere || out_[wish.goal] == kNowhere) continue;
    const Cell gate = entrance(wish.goal);
    if (entering[gate] < 0 || served_[gate] == robot) entering[gate] = robot;
  }
  for (int robot = 0; robot < robots; ++robot) {
    Wish& wish = wishes[robot];
    if (wish.yields || wish.goal == kNowhere || out_[wish.goal] == kNowhere) continue;
    if (entering[entrance(wish.goal)] != robot) wish.yields = true;
  }
  served_ = entering;
  for (const int robot : served_) {
    if (robot >= 0) serve(robot, tables, candidates, wishes);
  }
}

void DeadEnds::serve(int robot, DistanceTables& tables, Candidates& candidates,
                     std::vector<Wish>& wishes) {
  Wish& wish = wishes[robot];
  std::vector<Cell> way;
  int inner = -1;
  for (Cell cell = wish.goal; cell != wish.state.cell && out_[cell] != kNowhere;
       cell = out_[cell]) {
    way.push_back(cell);
    if (standing_[cell] >= 0) inner = standing_[cell];
  }
  const Cell gate = entrance(wish.goal);
  const int cells = std::abs(floor_.x(gate) - floor_.x(wish.state.cell)) +
                    std::abs(floor_.y(gate) - floor_.y(wish.state.cell));
  if (cells > kNear) return;
  for (const Cell cell : way) candidates.keep(cell);
  wish.is_urgent = wish.enters_kept = true;
  if (inner < 0) return;
  wish.yields = true;
  wish.is_urgent = false;
  Wish& other = wishes[inner];
  if (other.stopped || outside_[gate] == kNowhere) return;
  other.goal = outside_[gate];
  tables.need(other.deck, other.goal);
  tables.make();
  other.table = tables.find(other.deck, other.state.cell, other.goal, false);
  other.yields = false;
  other.is_urgent = other.enters_kept = true;
}

}  // namespace fleet
