// SPDX-License-Identifier: Apache-2.0
//
// Priority inheritance with backtracking: searches for a path of one robot and moves others aside
// for it, one after the other.
#pragma once

#include <cstdint>
#include <vector>

#include "core/search/candidates.h"
#include "core/search/priorities.h"
#include "core/search/reservations.h"

namespace fleet {

class PushSearch {
 public:
  /// Limits of a search.
  struct Limits {
    bool takes_all;  ///< false: only paths that do not raise the cost of all paths
    int pushes;      ///< robots that may still be moved aside
    int rank;        ///< only robots of a lower rank are moved; -1 = any robot
  };

  /// Keeps all references, which must outlive the object. `revisits`: largest number of times that
  /// one robot is moved aside for another in a search.
  PushSearch(const std::vector<Wish>& wishes, const Priorities& priorities, Candidates& candidates,
             Reservations& reserved, int revisits);

  /// Begins a step with `robots` robots.
  void begin(int robots);
  /// Begins a pass, in which each robot is moved at most once.
  void beginPass() { ++pass_; }
  /// Returns whether a robot has its path in this pass.
  bool isSettled(int robot) const { return settled_[robot] == pass_; }

  /// Notes that a robot has its path in this pass.
  void settle(int robot) { settled_[robot] = pass_; }

  /// Searches for another path of a robot and returns true; returns false, with all paths
  /// unchanged, if there is none.
  bool replan(int robot, Limits limits);

 private:
  bool insert(int robot, std::int64_t gain, Limits& limits);
  bool mayMove(int robot, const Limits& limits) const;
  void visit(int robot);
  std::int64_t weigh(int robot, const Path& path) const {
    return std::int64_t{priorities_.weight(robot)} * path.cost;
  }

  const std::vector<Wish>& wishes_;
  const Priorities& priorities_;
  Candidates& candidates_;
  Reservations& reserved_;
  const int revisits_;
  /// State by robot: the last search that reached it, its visits there, and the pass that moves it.
  std::vector<int> searched_, visits_, settled_;
  int pass_ = 0, search_ = 0;
};

}  // namespace fleet
