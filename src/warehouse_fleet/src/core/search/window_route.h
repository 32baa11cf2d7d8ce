// SPDX-License-Identifier: Apache-2.0
//
// The best path of one robot through a window of ticks among fixed paths, by A* over cells,
// headings and ticks.
#pragma once

#include <cstdint>
#include <vector>

#include "core/search/candidates.h"
#include "core/search/window_paths.h"

namespace fleet {

class WindowRoute {
 public:
  /// Keeps all references, which must outlive the object.
  WindowRoute(const Floor& floor, const Candidates& candidates, const WindowPaths& paths);

  /// Searches for the cheapest path of a robot without one, among the others' paths or regardless
  /// of them. Returns false if it would cost more than `most`. The cost [kTickCost] is that of the
  /// driven way and of the rest to the goal; a tick of waiting costs a tick.
  bool find(int robot, const Wish& wish, int most, bool among_others, WindowPath& path);

 private:
  struct Node {
    GridPose state;
    std::int32_t parent, cost, left;
    std::int16_t tick;
    bool has_arrived;
  };

  void push(int parent, GridPose state, bool has_arrived);
  void expand(int index);
  bool mayEnter(const Node& from, Cell to) const;
  bool isNew(const Node& node);
  void trace(int index, WindowPath& path) const;

  const Floor& floor_;
  const Candidates& candidates_;
  const WindowPaths& paths_;
  const int side_;  ///< cells along each side of the reachable square
  // The state of a search.
  int robot_ = 0;
  const Wish* wish_ = nullptr;
  bool among_others_ = true;
  int first_ = 0, most_ = 0;  ///< smallest and largest cost
  std::vector<Node> nodes_;
  std::vector<std::vector<std::int32_t>> queues_;  ///< by cost above the least
  int used_ = 0;                                   ///< queues
  std::vector<std::uint32_t> visited_by_;  ///< by state and tick: the last search that reached it
  std::uint32_t search_ = 0;
};

}  // namespace fleet
