// SPDX-License-Identifier: Apache-2.0
//
// Arbitration between robots that want to enter the same cell, or each other's.
#pragma once

#include <vector>

#include "rware/layout.h"

namespace rware {

/// The wish of a robot: cells, `to` equal to `from` if it stays.
struct MoveWish {
  int from, to;
};

/// Settles a step as RWARE does. Wishes are edges between cells, and every connected part of that
/// graph has at most one ring. Where there is none, the longest chain of robots moves; a ring of
/// three or more turns, all else in that part waits; two robots that face each other wait, with
/// all behind them.
class Arbiter {
 public:
  explicit Arbiter(const Layout& layout) : layout_(layout) {}
  /// `robot_at`: by cell, the robot there, or -1. Returns, by robot, whether its wish is granted.
  const std::vector<char>& settle(const std::vector<MoveWish>& wishes,
                                  const std::vector<int>& robot_at);

 private:
  void link(const std::vector<int>& robot_at);
  void commitRings();
  void measureChains();
  void commitChains();
  void commitChain(int head);
  int longest(const std::vector<int>& robots);
  std::vector<int> orderAround(int robot) const;

  const Layout& layout_;
  const std::vector<MoveWish>* wishes_ = nullptr;
  // By robot: the robot in the cell that it wants (itself if it stays, -1 if the cell is empty);
  // the length of the longest chain that ends with it; the robots that want its cell.
  std::vector<int> ahead_, length_;
  std::vector<std::vector<int>> behind_;
  std::vector<char> committed_, visited_;
};

}  // namespace rware
