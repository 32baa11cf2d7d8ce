// SPDX-License-Identifier: Apache-2.0
//
// For robots that get no nearer: a crowd in which everybody must turn before anybody can leave is
// not undone within the few ticks of an operation. Here priority inheritance with backtracking
// (Okumura et al., 2019) goes over cells alone, whatever the headings, and tells each robot in such
// a one's way the cell that it goes to next; that takes the ticks that it takes.
#pragma once

#include <vector>

#include "core/search/candidates.h"

namespace fleet {

class MakingWay {
 public:
  /// Who stands in a cell for more than `patience` ticks presses.
  MakingWay(const Floor& floor, int patience) : floor_(floor), patience_(patience) {}

  /// Tells who presses and who makes way where to go: overwrites their goals in `wishes`.
  /// `candidates` knows how far it is, and keeps their next cells for them: a robot that drives
  /// past would else always be there before one that must turn first.
  /// Without `may_press` no other robot begins to press.
  void direct(const Fleet& fleet, bool may_press, Candidates& candidates,
              std::vector<Wish>& wishes);

  /// Whether a robot was told where to go; those come first of all.
  bool isTold(int robot) const { return progress_[robot].told != kNowhere; }
  /// For how many ticks a robot had been in its cell on its way to a goal, a step ago.
  int still(int robot) const {
    return robot < static_cast<int>(progress_.size()) ? progress_[robot].still : 0;
  }

 private:
  struct Progress {
    Cell cell = kNowhere;  ///< where it is
    int still = 0;         ///< ticks for which it has been there on its way to a goal
    Cell goal = kNowhere;
    int nearest = 0;       ///< the least that it had still to go
    int stalled = 0;       ///< ticks since then
    Cell told = kNowhere;  ///< where to go next
    int patience = 0;      ///< ticks for which that holds
  };

  void watch(const Candidates& candidates, const std::vector<Wish>& wishes);
  void measure(const Candidates& candidates, const Wish& wish, Progress& progress) const;
  std::vector<int> pressing() const;
  void press(int robot, const Candidates& candidates, const std::vector<Wish>& wishes);
  bool move(int robot, const Candidates& candidates, const std::vector<Wish>& wishes, int& effort);
  std::vector<Cell> ways(const Candidates& candidates, const Wish& wish) const;

  const Floor& floor_;
  const int patience_;
  std::vector<Progress> progress_;
  std::vector<int> standing_;  ///< by cell: who, or -1
  std::vector<int> entering_;  ///< by cell: who was told to go there, or -1
  std::vector<int> chain_;     ///< those who were told in this search, the last first
  std::vector<std::uint8_t> is_asked_;
  std::vector<Cell> to_;  ///< of this search, by robot
};

}  // namespace fleet
