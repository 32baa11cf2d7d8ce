// SPDX-License-Identifier: Apache-2.0
//
// The quickest ways of a robot from one cell to all others, and vice versa.
#pragma once

#include <cstdint>
#include <vector>

#include "warehouse_layout/floor.h"

namespace layout {

/// The cells that a robot may pass, and the times of its steps. A node is a cell and a heading,
/// cell * kHeadings + heading.
struct RouteGraph {
  const Cell* next;         ///< by node: the neighbouring cell, or kNowhere; cells * kHeadings
  const std::uint8_t* end;  ///< by cell: ways end there, in the heading of arrival
  Cell cells;
  double step;  ///< time from cell to cell [s]
  double turn;  ///< time of a quarter turn [s]
};

/// The quickest ways, an entry a node: duration [s], infinity if no quickest way to a cell passes
/// the node; number of steps; the previous node, -1 for the first.
struct Routes {
  std::vector<double> seconds;
  std::vector<std::int32_t> steps;
  std::vector<std::int32_t> before;
};

/// Returns the quickest ways from a cell, starting in any heading. With reversed edges these are
/// the ways to the cell.
Routes routesFrom(const RouteGraph& graph, Cell start);

/// The quickest ways to a list of cells, each in the heading that is reached first: duration [s],
/// infinity if there is no way; number of steps.
struct Ways {
  std::vector<double> seconds;
  std::vector<std::int32_t> steps;
};

/// Returns the quickest ways from a cell to others, as routesFrom() finds them.
Ways waysFrom(const RouteGraph& graph, Cell start, const std::vector<Cell>& ends);

}  // namespace layout
