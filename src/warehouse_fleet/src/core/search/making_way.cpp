// SPDX-License-Identifier: Apache-2.0
#include "core/search/making_way.h"

#include <algorithm>

namespace fleet {
namespace {

constexpr int kStalled = 120;  // ticks without progress after which a robot presses
constexpr int kDirectedFor =
    12;  // ticks to reach the next cell, and as many for each robot in the way
constexpr int kDirectedForEach = 3;
constexpr int kEffort = 2000;  // cells that the search for one robot may try
// Cells that all searches of a step may try. Most robots that press stand in queues, behind one
// that is served, and their searches end at once.
constexpr int kEffortOfAll = 32000;

/// Returns whether it is committed to leave its cell.
bool drivesOn(const Wish& wish) {
  const auto end = wish.commitment.begin() + wish.committed;
  return std::find(wish.commitment.begin(), end, Action::kForward) != end;
}

}  // namespace

void MakingWay::direct(const Fleet& fleet, bool may_press, Candidates& candidates,
                       std::vector<Wish>& wishes) {
  watch(candidates, wishes);
  if (may_press) {
    int left = kEffortOfAll;
    for (const int robot : pressing()) {
      if (left <= 0) break;
      if (progress_[robot].next == kNowhere) left -= press(robot, candidates, wishes);
    }
  }
  for (int robot = 0; robot < fleet.size(); ++robot) {
    const Cell cell = progress_[robot].next;
    if (cell == kNowhere) continue;
    wishes[robot].goal = cell;
    wishes[robot].table = nullptr;
    candidates.keep(cell);
  }
}

/// Returns the robots that press in this step, those with the longest time without progress first.
std::vector<int> MakingWay::pressing() const {
  std::vector<int> pressing;
  for (int robot = 0; robot < static_cast<int>(progress_.size()); ++robot) {
    const Progress& progress = progress_[robot];
    const bool presses = progress.still > patience_ || progress.stalled > kStalled;
    if (presses && progress.next == kNowhere) pressing.push_back(robot);
  }
  std::sort(pressing.begin(), pressing.end(), [&](int robot, int other) {
    const int ours = progress_[robot].stalled, theirs = progress_[other].stalled;
    return ours != theirs ? ours > theirs : robot < other;
  });
  return pressing;
}

/// Updates which robots stand, and which have not reached their next cell.
void MakingWay::watch(const Candidates& candidates, const std::vector<Wish>& wishes) {
  if (progress_.size() > wishes.size()) progress_.clear();
  progress_.resize(wishes.size());
  to_.resize(wishes.size());
  standing_.assign(floor_.size(), -1);
  entering_.assign(floor_.size(), -1);
  for (int robot = 0; robot < static_cast<int>(wishes.size()); ++robot) {
    const Wish& wish = wishes[robot];
    Progress& progress = progress_[robot];
    standing_[wish.state.cell] = robot;
    const bool can_move = !wish.stopped && wish.committed == 0;
    const bool is_under_way =
        can_move && wish.goal != kNowhere && !wish.yields && wish.goal != wish.state.cell;
    progress.still = progress.cell == wish.state.cell && is_under_way ? progress.still + 1 : 0;
    progress.cell = wish.state.cell;
    measure(candidates, wish, progress);
    if (progress.cell == progress.next || --progress.patience < 0 || !can_move) {
      progress.next = kNowhere;
    }
    if (progress.next != kNowhere) entering_[progress.next] = robot;
  }
}

void MakingWay::measure(const Candidates& candidates, const Wish& wish, Progress& progress) const {
  const int distance =
      wish.goal == kNowhere || wish.yields ? 0 : candidates.distance(wish, wish.state);
  const bool is_new = progress.goal != wish.goal;
  if (is_new || distance == 0 || distance < progress.nearest) {
    progress.goal = wish.goal;
    progress.nearest = distance;
    progress.stalled = 0;
  } else {
    ++progress.stalled;
  }
}

/// Runs one step of priority inheritance, starting from this robot. Returns the number of cells
/// that it tried.
int MakingWay::press(int robot, const Candidates& candidates, const std::vector<Wish>& wishes) {
  chain_.clear();
  is_asked_.assign(wishes.size(), 0);
  int effort = kEffort;
  if (!move(robot, candidates, wishes, effort)) return kEffort - effort;
  for (const int directed : chain_) {
    progress_[directed].next = to_[directed];
    progress_[directed].patience =
        kDirectedFor + kDirectedForEach * static_cast<int>(chain_.size());
  }
  return kEffort - effort;
}

bool MakingWay::move(int robot, const Candidates& candidates, const std::vector<Wish>& wishes,
                     int& effort) {
  is_asked_[robot] = 1;
  for (const Cell cell : ways(candidates, wishes[robot])) {
    if (--effort < 0) return false;
    if (entering_[cell] >= 0) continue;
    const int other = standing_[cell];
    if (other >= 0) {
      const bool is_leaving = progress_[other].next != kNowhere || drivesOn(wishes[other]);
      const bool can_leave =
          !is_asked_[other] && !wishes[other].stopped && wishes[other].committed == 0;
      if (!is_leaving && !can_leave) continue;
      entering_[cell] = robot;
      if (!is_leaving && !move(other, candidates, wishes, effort)) {
        entering_[cell] = -1;
        continue;
      }
    }
    entering_[cell] = robot;
    to_[robot] = cell;
    chain_.push_back(robot);
    return true;
  }
  return false;
}

/// Returns the neighbouring cells, those nearest to its goal first.
std::vector<Cell> MakingWay::ways(const Candidates& candidates, const Wish& wish) const {
  std::vector<std::pair<int, Cell>> ways;
  for (int heading = 0; heading < kHeadings; ++heading) {
    const Cell cell = candidates.next(wish, wish.state.cell, heading);
    if (cell == kNowhere) continue;
    const int distance = wish.goal == kNowhere
                             ? 0
                             : candidates.distance(wish, {cell, static_cast<Heading>(heading)});
    ways.emplace_back(distance, cell);
  }
  std::sort(ways.begin(), ways.end());
  std::vector<Cell> cells;
  for (const auto& [distance, cell] : ways) cells.push_back(cell);
  return cells;
}

}  // namespace fleet
