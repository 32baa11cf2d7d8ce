// SPDX-License-Identifier: Apache-2.0
//
// One-way streets that obstacles cut into parts: how robots get out of them, and to units there.
#pragma once

#include <vector>

#include "warehouse_fleet/floor.h"

namespace fleet {

/// An edge against a one-way street: from a cell towards a heading.
struct BackEdge {
  Cell from;
  Heading heading;
};

/// Returns the edges that are to lead back as well while cells are `closed` (sorted), for all
/// robots. Those between two strongly connected parts of the streets do, so that what obstacles
/// leave connected can be driven to and left again; and those into closed cells, where robots may
/// stand. Stations' lanes stay one-way: loads have no room to turn there.
std::vector<BackEdge> waysBack(const Floor& floor, const std::vector<Cell>& closed);

/// Returns the edges on which a robot without a load comes to `units` in streets and lanes from
/// beyond: those that wait behind a unit may fill the street that leads to it. `closed`: sorted.
std::vector<BackEdge> waysToUnits(const Floor& floor, const std::vector<Cell>& closed,
                                  const std::vector<Cell>& units);

}  // namespace fleet
