// SPDX-License-Identifier: Apache-2.0
#include "core/floor/severed.h"

#include <algorithm>

#include "warehouse_layout/strong_bridges.h"

namespace fleet {
namespace {

using layout::Neighbours;

bool holds(const std::vector<Cell>& sorted, Cell cell) {
  return std::binary_search(sorted.begin(), sorted.end(), cell);
}

bool isStreet(const Floor& floor, Cell cell) {
  return floor.isPassable(cell) && !floor.isStorage(cell) && !floor.isLane(cell);
}

/// Returns the strongly connected part of each cell; -1 if it is closed, or no street.
std::vector<int> streetParts(const Floor& floor, const std::vector<Cell>& closed) {
  std::vector<Cell> streets, index(floor.size(), kNowhere);
  for (Cell cell = 0; cell < floor.size(); ++cell) {
    if (!isStreet(floor, cell) || holds(closed, cell)) continue;
    index[cell] = static_cast<Cell>(streets.size());
    streets.push_back(cell);
  }
  Neighbours ahead(streets.size(), {kNowhere, kNowhere, kNowhere, kNowhere}), back = ahead;
  for (const Cell cell : streets) {
    for (int heading = 0; heading < kHeadings; ++heading) {
      const Cell to = floor.next(Deck::kAisles, cell, heading);
      if (to == kNowhere || index[to] == kNowhere) continue;
      ahead[index[cell]][heading] = index[to];
      back[index[to]][heading] = index[cell];
    }
  }
  const std::vector<int> of_street = layout::strongParts(ahead, back);
  std::vector<int> part(floor.size(), -1);
  for (std::size_t i = 0; i < streets.size(); ++i) part[streets[i]] = of_street[i];
  return part;
}

BackEdge reversed(Cell to, int heading) { return {to, turned(heading, 2)}; }

}  // namespace

std::vector<BackEdge> waysBack(const Floor& floor, const std::vector<Cell>& closed) {
  if (closed.empty()) return {};
  const std::vector<int> part = streetParts(floor, closed);
  std::vector<BackEdge> edges;
  for (Cell cell = 0; cell < floor.size(); ++cell) {
    if (part[cell] < 0) continue;
    for (int heading = 0; heading < kHeadings; ++heading) {
      const Cell to = floor.next(Deck::kAisles, cell, heading);
      if (to == kNowhere || floor.isLane(to) || part[to] == part[cell]) continue;
      edges.push_back(reversed(to, heading));
    }
  }
  return edges;
}

std::vector<BackEdge> waysToUnits(const Floor& floor, const std::vector<Cell>& closed,
                                  const std::vector<Cell>& units) {
  std::vector<BackEdge> edges;
  std::vector<Cell> queue = units;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const Cell cell = queue[i];
    for (int heading = 0; heading < kHeadings; ++heading) {
      const Cell to = floor.next(Deck::kAisles, cell, heading);
      if (to == kNowhere || holds(closed, to)) continue;
      if (floor.isLane(to) && !floor.isLane(cell)) continue;
      edges.push_back(reversed(to, heading));
      if (floor.isLane(to)) queue.push_back(to);
    }
  }
  return edges;
}

}  // namespace fleet
