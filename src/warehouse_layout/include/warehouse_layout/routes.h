// SPDX-License-Identifier: Apache-2.0
//
// The quickest ways of a robot from one cell to all others, or to it from all others.
#pragma once

#include <cstdint>
#include <vector>

#include "warehouse_layout/floor.h"

namespace layout {

/// Which cells a robot may go through, and how long that takes. A node is a cell and a heading,
/// cell * kHeadings + heading.
struct RouteGraph {
  const Cell* next;         ///< by node: the cell beside it, or kNowhere; cells * kHeadings
  const std::uint8_t* end;  ///< by cell: ways end there, in the heading in which they come
  Cell cells;
  double step;  ///< from cell to cell [s]
  double turn;  ///< by a quarter [s]
};

/// The quickest ways, an entry a node: duration [s], infinity if no quickest way to a cell passes
/// the node; count of steps; the node before, -1 for the first.
struct Routes {
  std::vector<double> seconds;
  std::vector<std::int32_t> steps;
  std::vector<std::int32_t> before;
};

/// Returns the quickest ways from a cell, which begin in any heading. With edges turned round they
/// are those to the cell.
Routes routesFrom(const RouteGraph& graph, Cell start);

/// The quickest ways to a list of cells, each in the heading that is reached first: duration [s],
/// infinity if there is no way; count of steps.
struct Ways {
  std::vector<double> seconds;
  std::vector<std::int32_t> steps;
};

/// Returns the quickest ways from a cell to others, as routesFrom() finds them.
Ways waysFrom(const RouteGraph& graph, Cell start, const std::vector<Cell>& ends);

}  // namespace layout
