// SPDX-License-Identifier: Apache-2.0
#include "core/search/chain_search.h"

#include <algorithm>
#include <utility>

namespace fleet {
namespace {

constexpr int kMostTurns = 2;  // quarter turns to any heading

}  // namespace

ChainSearch::ChainSearch(const Floor& floor, const Rules& rules, int horizon,
                         const std::vector<Wish>& wishes, const Priorities& priorities,
                         const Candidates& candidates, Reservations& reserved, PushSearch& pushes)
    : floor_(floor),
      rules_(rules),
      horizon_(horizon),
      wishes_(wishes),
      priorities_(priorities),
      candidates_(candidates),
      reserved_(reserved),
      pushes_(pushes),
      from_(floor.size()),
      searched_(floor.size()) {}

bool ChainSearch::isStuck(int robot) const {
  const Wish& wish = wishes_[robot];
  if (wish.goal == kNowhere || wish.goal == wish.state.cell) return false;
  return reserved_.path(robot).cost >= candidates_.standing(wish).cost;
}

bool ChainSearch::advance(int robot) {
  const Wish& wish = wishes_[robot];
  if (wish.stopped || wish.committed > 0 || !isClear(wish.state.cell, robot)) return false;
  robot_ = robot;
  for (const int heading : waysNearer(wish)) {
    const Cell to = candidates_.next(wish, wish.state.cell, heading);
    for (int moving = turns(robot, heading); moving <= kMostTurns && moving < horizon_; ++moving) {
      if (find(to, moving) && place(moving)) return true;
    }
  }
  return false;
}

/// Returns the headings in which a robot gets nearer to its goal, the nearest first.
std::vector<int> ChainSearch::waysNearer(const Wish& wish) const {
  std::vector<std::pair<int, int>> ways;
  const int here = candidates_.distance(wish, wish.state);
  for (int heading = 0; heading < kHeadings; ++heading) {
    const Cell to = candidates_.next(wish, wish.state.cell, heading);
    if (to == kNowhere) continue;
    const int far = candidates_.distance(wish, {to, static_cast<Heading>(heading)});
    if (far < here) ways.emplace_back(far, heading);
  }
  std::sort(ways.begin(), ways.end());
  std::vector<int> headings;
  for (const auto& [far, heading] : ways) headings.push_back(heading);
  return headings;
}

/// Finds a chain from the robot over `first` whose robots move after `moving` ticks.
bool ChainSearch::find(Cell first, int moving) {
  const Cell begin = wishes_[robot_].state.cell;
  ++search_;
  searched_[begin] = searched_[first] = search_;
  from_[first] = begin;
  queue_ = {first};
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    const Cell cell = queue_[i];
    const int other = reserved_.who(cell, 0);
    if (!isClear(cell, other)) continue;
    Cell end = other == Reservations::kNobody ? cell : kNowhere;
    if (end == kNowhere && passes(cell, moving)) end = begin;
    if (end == kNowhere) continue;
    chain_.clear();
    if (end == begin) chain_.push_back(begin);
    for (Cell at = cell; at != begin; at = from_[at]) chain_.push_back(at);
    chain_.push_back(begin);
    return true;
  }
  return false;
}

/// Extends the search from the robot in a cell to all neighbours; returns whether that closes a
/// ring.
bool ChainSearch::passes(Cell cell, int moving) {
  const int robot = reserved_.who(cell, 0);
  const Wish& wish = wishes_[robot];
  const bool gives_way = !wish.stopped && wish.committed == 0 && !pushes_.isSettled(robot) &&
                         priorities_.rank(robot) > priorities_.rank(robot_);
  if (!gives_way) return false;
  const Cell begin = wishes_[robot_].state.cell;
  for (int heading = 0; heading < kHeadings; ++heading) {
    if (turns(robot, heading) > moving) continue;
    const Cell to = candidates_.next(wish, cell, heading);
    if (to == kNowhere) continue;
    if (to == begin && rules_.rings && from_[cell] != begin) return true;
    if (searched_[to] == search_) continue;
    searched_[to] = search_;
    from_[to] = cell;
    queue_.push_back(to);
  }
  return false;
}

/// Returns whether no other robot passes a cell.
bool ChainSearch::isClear(Cell cell, int robot) const {
  for (int tick = 1; tick <= horizon_; ++tick) {
    const int who = reserved_.who(cell, tick);
    if (who != Reservations::kNobody && who != robot && who != robot_) return false;
  }
  return true;
}

bool ChainSearch::place(int moving) {
  std::vector<std::pair<int, Path>> kept;
  for (std::size_t i = 1; i < chain_.size(); ++i) {
    const int robot = reserved_.who(chain_[i], 0);
    kept.emplace_back(robot, reserved_.path(robot));
    reserved_.remove(robot);
  }
  bool is_free = true;
  std::size_t placed = 0;
  for (; placed < kept.size() && is_free; ++placed) {
    const int robot = kept[placed].first;
    const Path path = moved(robot, chain_[placed], moving);
    is_free = candidates_.canDrive(path, wishes_[robot]) &&
              reserved_.conflict(robot, path) == Reservations::kNobody;
    if (is_free) reserved_.place(robot, path);
  }
  if (!is_free) {
    for (const auto& [robot, path] : kept) reserved_.remove(robot);
    for (const auto& [robot, path] : kept) reserved_.place(robot, path);
    return false;
  }
  for (const auto& [robot, path] : kept) pushes_.settle(robot);
  return true;
}

/// Returns the path of a robot that turns towards a neighbouring cell and moves there after
/// `moving` ticks.
Path ChainSearch::moved(int robot, Cell to, int moving) const {
  const Wish& wish = wishes_[robot];
  int heading = 0;
  while (floor_.beside(wish.state.cell, heading) != to) ++heading;
  Actions actions{};
  const int quarters = (heading - wish.state.heading) & 3;
  if (quarters == 3) actions[0] = Action::kTurnNegative;
  for (int i = 0; i < quarters && quarters < 3; ++i) actions[i] = Action::kTurnPositive;
  actions[moving] = Action::kForward;
  return candidates_.along(wish, actions);
}

int ChainSearch::turns(int robot, int heading) const {
  const int quarters = (heading - wishes_[robot].state.heading) & 3;
  return quarters == 3 ? 1 : quarters;
}

}  // namespace fleet
