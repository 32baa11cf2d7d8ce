// SPDX-License-Identifier: Apache-2.0
//
// Paths of many ticks, and the robot in each cell at each tick. The paths never conflict, so they
// are a plan at any moment.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/search/reservations.h"

namespace fleet {

constexpr int kMostWindow = 31;  ///< ticks of a window

struct WindowPath {
  std::array<GridPose, kMostWindow + 1> states;  ///< [0] is the present one
  int cost = 0;
};

class WindowPaths {
 public:
  WindowPaths(const Floor& floor, const Rules& rules, int ticks);

  static constexpr int kNobody = Reservations::kNobody;
  int ticks() const { return ticks_; }

  /// Removes all paths, and sets the number of robots.
  void clear(int robots);
  void place(int robot, const WindowPath& path);
  void remove(int robot);
  const WindowPath& path(int robot) const { return paths_[robot]; }
  /// Returns the robot in a cell at a tick; tick 0 is the present.
  int who(Cell cell, int tick) const { return table_[cell * stride_ + tick]; }

  /// Returns the robot that prevents a drive from `from` to `to` in one tick, or kNobody.
  int blocker(int robot, Cell from, Cell to, int tick) const;

 private:
  bool closesRing(Cell from, Cell to, int tick) const;

  const Rules rules_;
  const int ticks_, stride_;
  std::vector<std::int32_t> table_;
  std::vector<WindowPath> paths_;
  std::vector<std::uint8_t> is_placed_;
};

}  // namespace fleet
