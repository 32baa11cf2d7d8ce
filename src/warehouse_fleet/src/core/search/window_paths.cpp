// SPDX-License-Identifier: Apache-2.0
#include "core/search/window_paths.h"

namespace fleet {

WindowPaths::WindowPaths(const Floor& floor, const Rules& rules, int ticks)
    : rules_(rules),
      ticks_(ticks),
      stride_(ticks + 1),
      table_(static_cast<std::size_t>(floor.size()) * stride_, kNobody) {}

void WindowPaths::clear(int robots) {
  for (int robot = 0; robot < static_cast<int>(paths_.size()); ++robot) remove(robot);
  paths_.resize(robots);
  is_placed_.assign(robots, 0);
}

void WindowPaths::place(int robot, const WindowPath& path) {
  paths_[robot] = path;
  is_placed_[robot] = 1;
  for (int tick = 0; tick <= ticks_; ++tick) {
    table_[path.states[tick].cell * stride_ + tick] = robot;
  }
}

void WindowPaths::remove(int robot) {
  if (!is_placed_[robot]) return;
  is_placed_[robot] = 0;
  for (int tick = 0; tick <= ticks_; ++tick) {
    table_[paths_[robot].states[tick].cell * stride_ + tick] = kNobody;
  }
}

int WindowPaths::blocker(int robot, Cell from, Cell to, int tick) const {
  const int there = who(to, tick + 1);
  if (there != kNobody && there != robot) return there;
  if (from == to) return kNobody;
  const int leaving = who(to, tick);
  if (leaving == kNobody || leaving == robot) return kNobody;
  const bool swaps = who(from, tick + 1) == leaving;
  return swaps || (!rules_.rings && closesRing(from, to, tick)) ? leaving : kNobody;
}

/// Returns whether the chain of robots that make way for each other ends in the first one's cell.
bool WindowPaths::closesRing(Cell from, Cell to, int tick) const {
  for (int leaving = who(to, tick); leaving != kNobody; leaving = who(to, tick)) {
    const Cell next = paths_[leaving].states[tick + 1].cell;
    if (next == from) return true;
    if (next == to) return false;
    to = next;
  }
  return false;
}

}  // namespace fleet
