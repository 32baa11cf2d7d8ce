// SPDX-License-Identifier: Apache-2.0
#include "dead_ends.h"

#include <cstdlib>

namespace fleet {
namespace {

constexpr int kNear = 6;  // cells from the entrance to a robot for which others come out

std::vector<Cell> beside(const Floor& floor, Cell cell) {
  std::vector<Cell> cells;
  for (int heading = 0; heading < kHeadings; ++heading) {
    const Cell next = floor.next(Deck::kUnder, cell, heading);
    if (next != kNowhere) cells.push_back(next);
  }
  return cells;
}

}  // namespace

/// Takes away cell after cell that has but one neighbour left.
DeadEnds::DeadEnds(const Floor& floor)
    : floor_(floor),
      out_(floor.size(), kNowhere),
      outside_(floor.size(), kNowhere),
      served_(floor.size(), -1),
      standing_(floor.size(), -1) {
  std::vector<int> open(floor.size());
  std::vector<Cell> ends;
  for (Cell cell = 0; cell < floor.size(); ++cell) {
    open[cell] = static_cast<int>(beside(floor, cell).size());
    if (open[cell] == 1) ends.push_back(cell);
  }
  std::vector<std::uint8_t> is_end(floor.size());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (open[ends[i]] != 1) continue;  // the last cell of a floor without any ring
    is_end[ends[i]] = 1;
    for (const Cell next : beside(floor, ends[i])) {
      if (is_end[next]) continue;
      out_[ends[i]] = next;
      if (--open[next] == 1) ends.push_back(next);
    }
  }
  for (const Cell end : ends) {
    const Cell gate = out_[end];
    if (gate == kNowhere || is_end[gate]) continue;
    for (const Cell next : beside(floor, gate)) {
      const Cell best = outside_[gate];
      if (!is_end[next] && (best == kNowhere || open[next] > open[best])) outside_[gate] = next;
    }
  }
}

/// The cell before a dead end.
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
