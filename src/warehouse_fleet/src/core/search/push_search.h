// SPDX-License-Identifier: Apache-2.0
//
// Priority inheritance with backtracking: finds one robot a path for which others, one after the
// other, are moved aside.
#pragma once

#include <cstdint>
#include <vector>

#include "core/search/candidates.h"
#include "core/search/priorities.h"
#include "core/search/reservations.h"

namespace fleet {

class PushSearch {
 public:
  /// What a search may do.
  struct Limits {
    bool takes_all;  ///< or only what makes all paths together no dearer
    int pushes;      ///< how many more robots may be moved aside
    int rank;        ///< only robots of a lower rank; -1: any robot
  };

  /// All references must outlive it. `revisits`: how often one robot may be moved aside for
  /// another in a search.
  PushSearch(const std::vector<Wish>& wishes, const Priorities& priorities, Candidates& candidates,
             Reservations& reserved, int revisits);

  /// Begins a step with so many robots.
  void begin(int robots);
  /// Begins a pass, in which each robot is moved at most once.
  void beginPass() { ++pass_; }
  /// Tells whether this pass has given a robot its path.
  bool isSettled(int robot) const { return settled_[robot] == pass_; }

  /// Tells that a robot has its path in this pass.
  void settle(int robot) { settled_[robot] = pass_; }

  /// Finds a robot another path and returns true; returns false and leaves all paths as they were
  /// if there is none.
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
  /// By robot: the search that came to it last, how often, and the pass that moved or is moving it.
  std::vector<int> searched_, visits_, settled_;
  int pass_ = 0, search_ = 0;
};

}  // namespace fleet
