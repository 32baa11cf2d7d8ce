// SPDX-License-Identifier: Apache-2.0
#include "core/search/push_search.h"

namespace fleet {

PushSearch::PushSearch(const std::vector<Wish>& wishes, const Priorities& priorities,
                       Candidates& candidates, Reservations& reserved, int revisits)
    : wishes_(wishes),
      priorities_(priorities),
      candidates_(candidates),
      reserved_(reserved),
      revisits_(revisits) {}

void PushSearch::begin(int robots) {
  searched_.assign(robots, 0);
  visits_.assign(robots, 0);
  settled_.assign(robots, 0);
  pass_ = search_ = 0;
}

bool PushSearch::replan(int robot, Limits limits) {
  const Path kept = reserved_.path(robot);
  reserved_.remove(robot);
  ++search_;
  if (insert(robot, weigh(robot, kept), limits)) return true;
  reserved_.place(robot, kept);
  return false;
}

/// Searches for the best operation of `robot`, which has no path, for which others can be moved
/// aside. `gain` is the reduction of cost by the paths that have changed so far.
bool PushSearch::insert(int robot, std::int64_t gain, Limits& limits) {
  visit(robot);
  settled_[robot] = pass_;
  bool is_found = false;
  for (const Path& path : candidates_.of(robot, wishes_[robot])) {
    const int other = reserved_.conflict(robot, path);
    if (other == Reservations::kNobody) {
      is_found = limits.takes_all || gain >= weigh(robot, path);
      if (is_found) reserved_.place(robot, path);
      break;  // the next ones are no better
    }
    if (other == Reservations::kSeveral || !mayMove(other, limits)) continue;
    if (--limits.pushes < 0) break;
    const Path others = reserved_.path(other);
    reserved_.remove(other);
    reserved_.place(robot, path);
    is_found = insert(other, gain - weigh(robot, path) + weigh(other, others), limits);
    if (is_found) break;
    reserved_.remove(robot);
    reserved_.place(other, others);
  }
  if (!is_found) settled_[robot] = 0;
  return is_found;
}

/// Excludes robots that are being moved or have been moved, and those of a higher rank.
bool PushSearch::mayMove(int robot, const Limits& limits) const {
  if (isSettled(robot) || wishes_[robot].stopped) return false;
  if (searched_[robot] == search_ && visits_[robot] >= revisits_) return false;
  return limits.rank < 0 || priorities_.rank(robot) > limits.rank;
}

void PushSearch::visit(int robot) {
  if (searched_[robot] != search_) visits_[robot] = 0;
  searched_[robot] = search_;
  ++visits_[robot];
}

}  // namespace fleet
