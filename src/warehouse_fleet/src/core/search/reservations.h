// SPDX-License-Identifier: Apache-2.0
//
// The robot in each cell at each tick, and the conflicts of a new path with these.
#pragma once

#include <cstdint>
#include <vector>

#include "core/search/path.h"

namespace fleet {

class Reservations {
 public:
  Reservations(const Floor& floor, const Rules& rules, int horizon);

  static constexpr int kNobody = -1;
  static constexpr int kSeveral = -2;

  /// Begins a step with robots that stand in these cells, without paths.
  void begin(const Fleet& fleet);

  void place(int robot, const Path& path);
  void remove(int robot);
  /// Returns the robot in `cell` at a tick; tick 0 is the present.
  int who(Cell cell, int tick) const { return at(cell, tick); }
  const Path& path(int robot) const { return paths_[robot]; }
  bool has(int robot) const { return is_placed_[robot]; }

  /// Returns the robots with which `robot`, which has no path, would conflict on this path: none, a
  /// robot's number, or several (also for a robot that can't give way). Where following is not
  /// allowed, only committed actions must respect it: all others can wait.
  int conflict(int robot, const Path& path) const;

 private:
  static constexpr int kStride = 8;  ///< ticks of a cell lie in one cache line
  static_assert(kMaxHorizon < kStride);

  std::int32_t& at(Cell cell, int tick) { return table_[cell * kStride + tick]; }
  std::int32_t at(Cell cell, int tick) const { return table_[cell * kStride + tick]; }
  int entering(int robot, Cell from, Cell to, int tick) const;
  bool isStrict(int robot, int tick) const {
    return !rules_.following && robot >= 0 && tick <= committed_[robot];
  }
  bool closesRing(int robot, Cell from, Cell to, int tick) const;
  int turning(int robot, Cell cell, int tick) const;

  const Floor& floor_;
  const Rules rules_;
  const int horizon_;
  std::vector<std::int32_t> table_;
  std::vector<Path> paths_;
  std::vector<std::uint8_t> is_placed_, is_loaded_;
  std::vector<int> committed_;  ///< ticks
  std::vector<Cell> standing_;  ///< cells in which robots stand in this step
};

}  // namespace fleet
