// SPDX-License-Identifier: Apache-2.0
//
// Dijkstra's algorithm from a goal backwards, over a window of the floor.
#pragma once

#include <cstdint>
#include <vector>

#include "core/floor/guidance.h"
#include "warehouse_fleet/floor.h"

namespace fleet {

constexpr int kUnreachable = 0xffff;
constexpr int kMaxTurnTicks = 2;

/// Edges as they are now: what is closed taken away, and what each costs.
struct Edges {
  std::vector<Cell> next[2];  ///< by deck; by cell and heading
  const std::vector<std::uint8_t>* costs;
  std::vector<std::uint8_t> is_tight;  ///< by cell: a load can't be turned there; empty: nowhere
  std::vector<int> against[2] = {};    ///< those of `next` against a one-way street, by deck

  bool mayTurnEverywhere(Deck deck) const { return deck == Deck::kUnder || is_tight.empty(); }
  bool mayTurn(Deck deck, Cell cell) const { return mayTurnEverywhere(deck) || !is_tight[cell]; }
};

/// What it costs to drive along each edge, by deck; by cell and heading; 0: there is none. Searches
/// read one byte an edge instead of where it leads and what it costs.
struct Prices {
  std::vector<std::uint8_t> of[2];

  /// Computes them for the edges as they are now.
  void update(const Edges& edges);
};

/// A rectangle of cells.
struct Window {
  int left = 0, top = 0, columns = 0, rows = 0;

  int size() const { return columns * rows; }
};

/// All of a floor.
Window whole(const Floor& floor);
/// The cells no further than `reach` columns and rows from one, on the floor.
Window around(const Floor& floor, Cell cell, int reach);

/// What one thread needs for its searches.
class DistanceSearch {
 public:
  /// A quarter turn costs `turn_ticks`. All references must outlive it.
  DistanceSearch(const Floor& floor, const Edges& edges, const Prices& prices, int turn_ticks);

  /// Finds what it costs to get to `goal` from each cell and heading in a window, by ways within
  /// the window. With `is_entered` the goal can be reached even if it is closed.
  void run(Deck deck, Cell goal, const Window& window, bool is_entered);

  /// The cost that was found in the last window [kTickCost]; kUnreachable.
  int cost(Cell cell, int heading) const { return cost_[cell * kHeadings + heading]; }
  /// Replaces it.
  void set(Cell cell, int heading, int cost) {
    cost_[cell * kHeadings + heading] = static_cast<std::uint16_t>(cost);
  }

  /// Writes the costs of the last window, a word a cell, row after row: see DistanceTable.
  void pack(std::vector<std::uint32_t>& words) const;
  /// Writes those of these cells alone, after a word that says that there is no way.
  void pack(const std::vector<Cell>& cells, std::vector<std::uint32_t>& words) const;

 private:
  void open(const Window& window);
  void push(int state, int cost);
  void relax(int state, int cost);
  void enter(Cell cell, int heading, int cost);
  int price(Cell cell, int edge) const;

  const Floor& floor_;
  const Edges& edges_;
  const Prices& prices_;
  const int turn_cost_;
  int step_[kHeadings];
  bool has_lanes_ = false;
  // Of a search: costs by cell and heading, 0 beyond the window, so that nothing is entered there;
  // and a ring of queues, one a cost.
  std::vector<std::uint16_t> cost_;
  std::vector<std::vector<std::int32_t>> queues_;
  Window window_;
  Deck deck_ = Deck::kUnder;
  Cell goal_ = kNowhere;
  bool turns_everywhere_ = true;
  const std::uint8_t* price_ = nullptr;  ///< of the deck
  const Cell* into_goal_ = nullptr;
};

}  // namespace fleet
