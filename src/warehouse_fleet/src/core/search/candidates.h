// SPDX-License-Identifier: Apache-2.0
//
// What each robot could do next, the best first.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/floor/distance_tables.h"
#include "core/parallel/threads.h"
#include "core/search/path.h"

namespace fleet {

/// Where one robot is and wants to go.
struct Wish {
  State state;
  Deck deck = Deck::kUnder;
  Cell goal = kNowhere;
  Cell home = kNowhere;                  ///< a storage place that it may enter
  const DistanceTable* table = nullptr;  ///< to the goal; nullptr: not known yet
  int committed = 0;                     ///< its first actions are these
  Actions commitment{};
  bool stopped = false;
  bool stops_at_goal = true;
  bool yields = false;       ///< goes wherever it is pushed, its goal can wait
  bool is_urgent = false;    ///< goes first of all
  bool enters_kept = false;  ///< kept cells are kept for it
};

class Candidates {
 public:
  /// Operations of `depth` ticks, in plans of `horizon` ticks.
  Candidates(const Floor& floor, const Edges& edges, int depth, int horizon);

  /// Begins a step: no candidates are known, no cell is kept.
  void begin(int robots);
  /// Closes a cell in this step for robots whose goal it is not, unless they are committed to it.
  void keep(Cell cell);

  /// Works them out, once a step.
  const std::vector<Path>& of(int robot, const Wish& wish);
  /// Works out those of all robots with a goal, on all threads: others mostly stand.
  void find(const std::vector<Wish>& wishes, const Threads& threads);

  /// Returns the candidate that keeps to what is committed, and stands from then on. It is allowed
  /// if no other robot is in its way.
  Path standing(const Wish& wish) const;
  /// Returns the path of these actions from where the robot stands, which must lead along edges.
  Path along(const Wish& wish, const Actions& actions) const;
  /// What is left of a path that was planned from `begin`, a tick ago or longer: keeps to what is
  /// committed, goes on from there as planned, and stands from then on, or at once if the path does
  /// not lead there. `is_punctual` if the robot is as far as was planned.
  Path rest(const Path& path, const State& begin, const Wish& wish, bool& is_punctual) const;
  /// Whether a path from where it stands leads along edges that there are, as it is committed to.
  bool canDrive(const Path& path, const Wish& wish) const;

  /// The cell in front of one who stands in `cell`, on its deck or its own storage place.
  Cell next(const Wish& wish, Cell cell, int heading) const;
  /// Whether a robot may turn in a cell.
  bool mayTurn(const Wish& wish, Cell cell) const { return edges_.mayTurn(wish.deck, cell); }
  /// How far it is to the goal from there, in kTickCost: an estimate while there is no table.
  int distance(const Wish& wish, State state) const;

 private:
  State commit(const Wish& wish, Path& path) const;
  bool hasRoomToTurn(const Wish& wish, const Path& path, const Actions& actions) const;
  bool isDeadEnd(const Wish& wish, Cell cell, int heading) const;
  int cost(const Wish& wish, const Path& path, int heading) const;
  /// What one thread needs for it.
  struct Scratch {
    std::vector<Cell> reached;  ///< by node of a tree of operations
    std::vector<Path> paths;
    std::vector<std::pair<int, int>> order;  ///< of paths: cost, index
  };
  void find(int robot, const Wish& wish, Scratch& scratch);
  void grow(const Wish& wish, Scratch& scratch) const;

  const Floor& floor_;
  const Edges& edges_;
  const int depth_, horizon_;
  std::vector<std::unique_ptr<Operations>> operations_;  ///< by ticks that are free
  std::vector<std::vector<Path>> paths_;
  std::vector<std::uint8_t> is_known_;
  std::vector<std::uint8_t> is_kept_;  ///< by cell
  std::vector<Cell> kept_;
  std::vector<Scratch> scratch_;  ///< one a thread
};

}  // namespace fleet
