// SPDX-License-Identifier: Apache-2.0
//
// Chains that move a robot into an occupied cell, on a floor with hardly a free cell: the shortest
// chain of robots, each into the cell of the next, the last into a free cell or, where rings are
// allowed, into the cell of the first. All turn first, then all move in the same tick. The search
// is breadth first, so its time is linear in the floor's cells; priority inheritance would try all
// orders of pushing.
#pragma once

#include <vector>

#include "core/search/push_search.h"

namespace fleet {

class ChainSearch {
 public:
  /// Keeps all references, which must outlive the object.
  ChainSearch(const Floor& floor, const Rules& rules, int horizon, const std::vector<Wish>& wishes,
              const Priorities& priorities, const Candidates& candidates, Reservations& reserved,
              PushSearch& pushes);

  /// Returns whether a robot's path does not lead nearer to its goal.
  bool isStuck(int robot) const;

  /// Moves a robot a cell nearer to its goal, and unsettled robots of lower rank out of its way;
  /// settles them all. Returns false, with all paths unchanged, if it can't.
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
  int robot_ = 0;              ///< the robot to get nearer
  std::vector<Cell> from_;     ///< by cell: the cell before it in the chain
  std::vector<int> searched_;  ///< by cell: the last search that reached it
  int search_ = 0;
  std::vector<Cell> queue_;
  std::vector<Cell> chain_;  ///< the chain, the last cell first, the robot's own at the end
};

}  // namespace fleet
