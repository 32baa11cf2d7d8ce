// SPDX-License-Identifier: Apache-2.0
//
// The possible next paths of each robot, the best first.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/floor/distance_tables.h"
#include "core/parallel/threads.h"
#include "core/search/path.h"

namespace fleet {

/// The pose and goal of one robot.
struct Wish {
  GridPose state;
  Deck deck = Deck::kUnder;
  Cell goal = kNowhere;
  Cell home = kNowhere;                  ///< a storage place that it may enter
  const DistanceTable* table = nullptr;  ///< table to the goal; nullptr: none yet
  int committed = 0;  ///< number of its committed actions, which its path begins with
  Actions commitment{};
  bool stopped = false;
  bool stops_at_goal = true;
  bool yields = false;       ///< goes where it is pushed; its goal can wait
  bool is_urgent = false;    ///< chooses before all others
  bool enters_kept = false;  ///< may enter the cells that are kept
};

class Candidates {
 public:
  /// Makes operations of `depth` ticks, in plans of `horizon` ticks.
  Candidates(const Floor& floor, const Edges& edges, int depth, int horizon);

  /// Begins a step without candidates and without kept cells.
  void begin(int robots);
  /// Closes a cell in this step for robots with other goals, unless they are committed to it.
  void keep(Cell cell);

  /// Computes a robot's candidates, once a step.
  const std::vector<Path>& of(int robot, const Wish& wish);
  /// Computes the candidates of all robots with a goal, on all threads; other robots mostly stand.
  void find(const std::vector<Wish>& wishes, const Threads& threads);

  /// Returns the candidate that drives the committed actions and then stands. It is allowed if no
  /// other robot is in its way.
  Path standing(const Wish& wish) const;
  /// Returns the path of these actions from the robot's pose; they must lead along edges.
  Path along(const Wish& wish, const Actions& actions) const;
  /// Returns the rest of a path that was planned from `begin`, a tick ago or longer: the committed
  /// actions, the planned ones after them, then standing; or standing at once if the path leads
  /// elsewhere. `is_punctual`: the robot is as far as planned.
  Path rest(const Path& path, const GridPose& begin, const Wish& wish, bool& is_punctual) const;
  /// Returns whether a robot's path leads along open edges, and keeps its committed actions.
  bool canDrive(const Path& path, const Wish& wish) const;

  /// Returns the cell in front of a robot in `cell`, on its deck or its own storage place.
  Cell next(const Wish& wish, Cell cell, int heading) const;
  /// Returns whether a robot may turn in a cell.
  bool mayTurn(const Wish& wish, Cell cell) const { return edges_.mayTurn(wish.deck, cell); }
  /// Returns the distance to the goal [kTickCost]; an estimate while there is no table.
  int distance(const Wish& wish, GridPose state) const;

 private:
  GridPose commit(const Wish& wish, Path& path) const;
  bool hasRoomToTurn(const Wish& wish, const Path& path, const Actions& actions) const;
  bool isDeadEnd(const Wish& wish, Cell cell, int heading) const;
  int cost(const Wish& wish, const Path& path, int heading) const;
  /// The memory of one thread.
  struct Scratch {
    std::vector<Cell> reached;  ///< by node of the tree of operations
    std::vector<Path> paths;
    std::vector<std::pair<int, int>> order;  ///< cost and index of each path
  };
  void find(int robot, const Wish& wish, Scratch& scratch);
  void grow(const Wish& wish, Scratch& scratch) const;

  const Floor& floor_;
  const Edges& edges_;
  const int depth_, horizon_;
  std::vector<std::unique_ptr<Operations>> operations_;  ///< by uncommitted ticks
  std::vector<std::vector<Path>> paths_;
  std::vector<std::uint8_t> is_known_;
  std::vector<std::uint8_t> is_kept_;  ///< by cell
  std::vector<Cell> kept_;
  std::vector<Scratch> scratch_;  ///< one a thread
};

}  // namespace fleet
