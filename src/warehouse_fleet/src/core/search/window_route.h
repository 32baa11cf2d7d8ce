// SPDX-License-Identifier: Apache-2.0
//
// The best path of one robot through a window of ticks among paths that are fixed: A* over cells,
// headings and ticks.
#pragma once

#include <cstdint>
#include <vector>

#include "core/search/candidates.h"
#include "core/search/window_paths.h"

namespace fleet {

class WindowRoute {
 public:
  /// All references must outlive it.
  WindowRoute(const Floor& floor, const Candidates& candidates, const WindowPaths& paths);

  /// Finds the cheapest path of a robot that has none, among those of the others, or without a look
  /// at them. Returns false if it would cost more than `most`. The cost is that of the ways driven
  /// and of those left at the end, in kTickCost; a tick of waiting costs a tick.
  bool find(int robot, const Wish& wish, int most, bool among_others, WindowPath& path);

 private:
  struct Node {
    State state;
    std::int32_t parent, cost, left;
    std::int16_t tick;
    bool has_arrived;
  };

  void push(int parent, State state, bool has_arrived);
  void expand(int index);
  bool mayEnter(const Node& from, Cell to) const;
  bool isNew(const Node& node);
  void trace(int index, WindowPath& path) const;

  const Floor& floor_;
  const Candidates& candidates_;
  const WindowPaths& paths_;
  const int side_;  ///< cells along each side of what can be reached
  // Of a search:
  int robot_ = 0;
  const Wish* wish_ = nullptr;
  bool among_others_ = true;
  int first_ = 0, most_ = 0;  ///< least cost, and what it may be
  std::vector<Node> nodes_;
  std::vector<std::vector<std::int32_t>> queues_;  ///< by cost above the least
  int used_ = 0;                                   ///< queues
  std::vector<std::uint32_t> seen_;                ///< by state and tick: the search
  std::uint32_t search_ = 0;
};

}  // namespace fleet
