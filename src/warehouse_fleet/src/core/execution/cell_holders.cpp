// SPDX-License-Identifier: Apache-2.0
#include "warehouse_fleet/cell_holders.h"

#include <algorithm>

namespace fleet {

CellHolders::CellHolders(const Floor& floor)
    : floor_(floor),
      holder_(floor.size(), kNobody),
      closed_until_(floor.size(), -1),
      is_in_zone_(floor.size(), 0),
      is_in_closed_zone_(floor.size(), 0) {}

void CellHolders::clear() { std::fill(holder_.begin(), holder_.end(), kNobody); }

void CellHolders::free(Cell cell, int robot) {
  if (holder_[cell] == robot) holder_[cell] = kNobody;
}

void CellHolders::close(Cell cell, double until) {
  if (!floor_.has(cell)) return;
  if (std::find(closing_.begin(), closing_.end(), cell) == closing_.end()) closing_.push_back(cell);
  closed_until_[cell] = std::max(closed_until_[cell], until);
}

bool CellHolders::isClosing(double now) const {
  return std::any_of(closing_.begin(), closing_.end(),
                     [&](Cell cell) { return isClosed(cell, now); });
}

void CellHolders::setZone(std::vector<Cell> cells) {
  replace(std::move(cells), zone_, is_in_zone_);
}

void CellHolders::setClosedZone(std::vector<Cell> cells) {
  replace(std::move(cells), closed_zone_, is_in_closed_zone_);
}

void CellHolders::replace(std::vector<Cell> cells, std::vector<Cell>& zone,
                          std::vector<std::uint8_t>& is_in) const {
  for (const Cell cell : zone) is_in[cell] = 0;
  cells.erase(std::remove_if(cells.begin(), cells.end(), [this](Cell c) { return !floor_.has(c); }),
              cells.end());
  zone = std::move(cells);
  for (const Cell cell : zone) is_in[cell] = 1;
}

std::vector<Cell> CellHolders::closed(double now) const {
  std::vector<Cell> closed = zone_;
  for (const Cell cell : closing_) {
    if (isClosed(cell, now)) closed.push_back(cell);
  }
  return closed;
}

}  // namespace fleet
