// SPDX-License-Identifier: Apache-2.0
//
// Moves a robot into a cell that is taken on a floor with hardly a free cell: the shortest chain of
// robots, each into the cell of the next, the last into a free cell or, where rings are allowed,
// into the cell of the first. All turn first, then all move in the same tick. Breadth first, so it
// takes no longer than the floor has cells; priority inheritance would try all orders of pushing.
#pragma once

#include <vector>

#include "core/search/push_search.h"

namespace fleet {

class ChainSearch {
 public:
  /// All references must outlive it.
  ChainSearch(const Floor& floor, const Rules& rules, int horizon, const std::vector<Wish>& wishes,
              const Priorities& priorities, const Candidates& candidates, Reservations& reserved,
              PushSearch& pushes);

  /// Tells whether its path leads a robot no nearer to its goal.
  bool isStuck(int robot) const;

  /// Moves a robot a cell nearer to its goal, and robots of lower rank that are not settled out of
  /// its way; settles them all. Returns false and leaves all paths as they were if it can't.
  bool advance(int robot);

 private:
  std::vector<int> waysNearer(const Wish& wish) const;
  bool find(Cell first, int moving);
  bool passes(Cell cell, int moving);
  bool isClear(Cell cell, int robot) const;
  bool place(int moving);
  Path moved(int robot, Cell to, int moving) const;
  int turns(int robot, int heading) const;

  const Floor& floor_;
  const Rules rules_;
  const int horizon_;
  const std::vector<Wish>& wishes_;
  const Priorities& priorities_;
  const Candidates& candidates_;
  Reservations& reserved_;
  PushSearch& pushes_;
  int robot_ = 0;              ///< that is to get nearer
  std::vector<Cell> from_;     ///< by cell: the cell before it in the chain
  std::vector<int> searched_;  ///< by cell: the search that came to it last
  int search_ = 0;
  std::vector<Cell> queue_;
  std::vector<Cell> chain_;  ///< what was found, the last cell first, the robot's own at the end
};

}  // namespace fleet
