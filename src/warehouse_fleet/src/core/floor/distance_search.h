// SPDX-License-Identifier: Apache-2.0
//
// Dijkstra's algorithm, backwards from a goal over a window of the floor.
#pragma once

#include <cstdint>
#include <vector>

#include "core/floor/guidance.h"
#include "warehouse_fleet/floor.h"

namespace fleet {

constexpr int kUnreachable = 0xffff;
constexpr int kMaxTurnTicks = 2;

/// The open edges, and the cost of each.
struct Edges {
  std::vector<Cell> next[2];  ///< by deck; by cell and heading
  const std::vector<std::uint8_t>* costs;
  std::vector<std::uint8_t> is_tight;  ///< by cell: a load can't turn there; empty = nowhere
  std::vector<int> against[2] = {};    ///< edges of `next` against a one-way street, by deck

  bool mayTurnEverywhere(Deck deck) const { return deck == Deck::kUnder || is_tight.empty(); }
  bool mayTurn(Deck deck, Cell cell) const { return mayTurnEverywhere(deck) || !is_tight[cell]; }
};

/// The cost of driving along each edge, by deck, cell and heading; 0 = no edge. Searches read one
/// byte an edge instead of a cell and a cost.
struct Prices {
  std::vector<std::uint8_t> of[2];

  /// Computes the costs of the open edges.
  void update(const Edges& edges);
};

/// A rectangle of cells.
struct Window {
  int left = 0, top = 0, columns = 0, rows = 0;

  int size() const { return columns * rows; }
};

/// Returns the whole floor.
Window whole(const Floor& floor);
/// Returns the cells of the floor within `reach` columns and rows of a cell.
Window around(const Floor& floor, Cell cell, int reach);

/// The memory of one thread for its searches.
class DistanceSearch {
 public:
  /// A quarter turn costs `turn_ticks`. All references must outlive it.
  DistanceSearch(const Floor& floor, const Edges& edges, const Prices& prices, int turn_ticks);

  /// Computes the cost of reaching `goal` from each cell and heading in a window, by ways within
  /// the window. `is_entered`: the goal can be reached even if it is closed.
  void run(Deck deck, Cell goal, const Window& window, bool is_entered);

  /// Returns the cost in the last window [kTickCost], or kUnreachable.
  int cost(Cell cell, int heading) const { return cost_[cell * kHeadings + heading]; }
  /// Replaces that cost.
  void set(Cell cell, int heading, int cost) {
    cost_[cell * kHeadings + heading] = static_cast<std::uint16_t>(cost);
  }

  /// Writes the costs of the last window, a word a cell, row after row: see DistanceTable.
  void pack(std::vector<std::uint32_t>& words) const;
  /// Writes the costs of `cells` alone, after a word for cells without a way.
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
  // The state of a search: costs by cell and heading, 0 beyond the window, so that the search does
  // not enter it; and a ring of queues, one for each cost.
  std::vector<std::uint16_t> cost_;
  std::vector<std::vector<std::int32_t>> queues_;
  Window window_;
  Deck deck_ = Deck::kUnder;
  Cell goal_ = kNowhere;
  bool turns_everywhere_ = true;
  const std::uint8_t* price_ = nullptr;  ///< costs of the deck
  const Cell* into_goal_ = nullptr;
};

}  // namespace fleet
