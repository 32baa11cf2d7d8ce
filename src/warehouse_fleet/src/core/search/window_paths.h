// SPDX-License-Identifier: Apache-2.0
//
// Paths of many ticks, and which robot is in which cell at each tick. The paths never conflict, so
// that they are a plan at any moment.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/search/reservations.h"

namespace fleet {

constexpr int kMostWindow = 31;  ///< ticks of a window

struct WindowPath {
  std::array<State, kMostWindow + 1> states;  ///< [0] is where it stands now
  int cost = 0;
};

class WindowPaths {
 public:
  WindowPaths(const Floor& floor, const Rules& rules, int ticks);

  static constexpr int kNobody = Reservations::kNobody;
  int ticks() const { return ticks_; }

  /// Removes all paths; so many robots may have one.
  void clear(int robots);
  void place(int robot, const WindowPath& path);
  void remove(int robot);
  const WindowPath& path(int robot) const { return paths_[robot]; }
  /// Who is in a cell at a tick, 0 for now.
  int who(Cell cell, int tick) const { return table_[cell * stride_ + tick]; }

  /// Returns who keeps a robot without a path from being in `to` a tick after it was in `from`;
  /// kNobody: no robot does.
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
