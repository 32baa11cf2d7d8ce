// SPDX-License-Identifier: Apache-2.0
//
// Making way for robots without progress. A crowd in which all must turn before one can leave does
// not dissolve within the few ticks of an operation. Here priority inheritance with backtracking
// (Okumura et al., 2019) works on cells alone, whatever the headings, and directs each robot in the
// way to its next cell, however many ticks that takes.
#pragma once

#include <vector>

#include "core/search/candidates.h"

namespace fleet {

class MakingWay {
 public:
  /// `patience`: ticks in one cell after which a robot presses.
  MakingWay(const Floor& floor, int patience) : floor_(floor), patience_(patience) {}

  /// Directs robots that press, and robots that make way: overwrites their goals in `wishes`.
  /// `candidates` gives distances, and keeps the next cells for them: passing robots would
  /// otherwise always precede a robot that must turn first. No further robot begins to press unless
  /// `may_press`.
  void direct(const Fleet& fleet, bool may_press, Candidates& candidates,
              std::vector<Wish>& wishes);

  /// Returns whether a robot is directed to a cell; directed robots choose first.
  bool isDirected(int robot) const { return progress_[robot].next != kNowhere; }
  /// Returns the ticks that a robot had spent in its cell on its way to a goal, one step ago.
  int still(int robot) const {
    return robot < static_cast<int>(progress_.size()) ? progress_[robot].still : 0;
  }

 private:
  struct Progress {
    Cell cell = kNowhere;  ///< cell of the robot
    int still = 0;         ///< ticks there on its way to a goal
    Cell goal = kNowhere;
    int nearest = 0;       ///< smallest distance to the goal so far
    int stalled = 0;       ///< ticks since then
    Cell next = kNowhere;  ///< the cell to which it is directed
    int patience = 0;      ///< ticks for which the direction holds
  };

  void watch(const Candidates& candidates, const std::vector<Wish>& wishes);
  void measure(const Candidates& candidates, const Wish& wish, Progress& progress) const;
  std::vector<int> pressing() const;
  int press(int robot, const Candidates& candidates, const std::vector<Wish>& wishes);
  bool move(int robot, const Candidates& candidates, const std::vector<Wish>& wishes, int& effort);
  std::vector<Cell> ways(const Candidates& candidates, const Wish& wish) const;

  const Floor& floor_;
  const int patience_;
  std::vector<Progress> progress_;
  std::vector<int> standing_;  ///< by cell: the robot there, or -1
  std::vector<int> entering_;  ///< by cell: the robot directed there, or -1
  std::vector<int> chain_;     ///< robots directed in this search, the last first
  std::vector<std::uint8_t> is_asked_;
  std::vector<Cell> to_;  ///< by robot, in this search
};

}  // namespace fleet
