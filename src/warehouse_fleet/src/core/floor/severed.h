// SPDX-License-Identifier: Apache-2.0
//
// One-way streets that obstacles cut, and the edges by which robots leave their parts and reach
// units there.
#pragma once

#include <vector>

#include "warehouse_fleet/floor.h"

namespace fleet {

/// An edge against a one-way street: from a cell towards a heading.
struct BackEdge {
  Cell from;
  Heading heading;
};

/// Returns the edges of one-way streets that become two-way, for all robots, while cells are
/// `closed` (sorted). These are edges between strongly connected parts of the streets, so that
/// every cell that is still connected can be reached and left again; and edges into closed cells,
/// where robots may stand. Stations' lanes stay one-way: loads have no room to turn there.
std::vector<BackEdge> waysBack(const Floor& floor, const std::vector<Cell>& closed);

/// Returns the edges on which a robot without a load reaches `units` in streets and lanes from the
/// far end: robots that wait behind a unit may fill the street that leads to it. `closed`: sorted.
std::vector<BackEdge> waysToUnits(const Floor& floor, const std::vector<Cell>& closed,
                                  const std::vector<Cell>& units);

}  // namespace fleet
