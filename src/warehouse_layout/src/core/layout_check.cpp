// SPDX-License-Identifier: Apache-2.0
#include "warehouse_layout/layout_check.h"

#include <algorithm>
#include <sstream>

namespace layout {
namespace {

using Kind = LayoutFault::Kind;

/// Searches the aisles' deck along its edges and against them.
class Aisles {
 public:
  explicit Aisles(const Floor& floor) : floor_(floor), seen_(floor.size(), 0) {
    for (Cell cell = 0; cell < floor.size(); ++cell) {
      if (isCore(cell)) core_.push_back(cell);
    }
  }

  std::vector<LayoutFault> faults() {
    if (core_.empty()) return {{Kind::kNoAisles, {}}};
    std::vector<LayoutFault> faults;
    if (auto cells = cutOff(); !cells.empty()) faults.push_back({Kind::kCutOff, cells});
    if (auto cells = deadEnds(); !cells.empty()) faults.push_back({Kind::kDeadEnd, cells});
    return faults;
  }

 private:
  bool isCore(Cell cell) const {
    return floor_.isPassable(cell) && !floor_.isStorage(cell) && !floor_.isLane(cell);
  }

  /// Returns core cells that are not strongly connected with the others, and storage places and
  /// lane cells without a way to them and back.
  std::vector<Cell> cutOff() {
    std::vector<std::uint8_t> ahead, back;
    for (const bool is_forward : {true, false}) {
      auto& reached = is_forward ? ahead : back;
      reached.assign(floor_.size(), 0);
      spread(largestPart(), is_forward, true, reached);
      // Then from the core into lanes and storage places.
      for (const Cell cell : std::vector<Cell>(core_)) {
        if (reached[cell]) spread(cell, is_forward, false, reached);
      }
    }
    std::vector<Cell> cells;
    for (Cell cell = 0; cell < floor_.size(); ++cell) {
      if (floor_.isPassable(cell) && !(ahead[cell] && back[cell])) cells.push_back(cell);
    }
    return cells;
  }

  /// Returns a cell of the largest strongly connected part of the core.
  Cell largestPart() {
    Cell best = core_.front();
    std::size_t most = 0;
    std::vector<std::uint8_t> known(floor_.size(), 0);
    for (const Cell cell : core_) {
      if (known[cell]) continue;
      std::vector<std::uint8_t> ahead(floor_.size(), 0), back(floor_.size(), 0);
      spread(cell, true, true, ahead);
      spread(cell, false, true, back);
      std::size_t size = 0;
      for (const Cell other : core_) {
        if (!ahead[other] || !back[other]) continue;
        known[other] = 1;
        ++size;
      }
      if (size > most) {
        most = size;
        best = cell;
      }
    }
    return best;
  }

  void spread(Cell start, bool is_forward, bool core_only, std::vector<std::uint8_t>& reached) {
    std::vector<Cell> queue = {start};
    reached[start] = 1;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const Cell cell = queue[i];
      for (int heading = 0; heading < kHeadings; ++heading) {
        const Cell to = is_forward ? step(cell, heading) : stepBack(cell, heading);
        if (to == kNowhere || reached[to] || (core_only && !isCore(to))) continue;
        // No loaded robot drives through a storage place.
        if (floor_.isStorage(cell) && floor_.isStorage(to)) continue;
        reached[to] = 1;
        queue.push_back(to);
      }
    }
  }

  Cell step(Cell cell, int heading) const { return floor_.next(Deck::kUnder, cell, heading); }

  Cell stepBack(Cell cell, int heading) const {
    const Cell from = floor_.beside(cell, heading + 2);
    return from != kNowhere && step(from, heading) == cell ? from : kNowhere;
  }

  std::vector<Cell> deadEnds() {
    std::vector<Cell> cells;
    for (const Cell from : core_) {
      for (int heading = 0; heading < kHeadings; ++heading) {
        const Cell to = step(from, heading);
        if (to == kNowhere || !isCore(to) || leadsBack(from, to)) continue;
        cells.push_back(from);
        cells.push_back(to);
      }
    }
    return cells;
  }

  /// Tells whether there is a way from `to` to `from` other than the one edge.
  bool leadsBack(Cell from, Cell to) {
    ++search_;
    queue_.assign(1, to);
    seen_[to] = search_;
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      for (int heading = 0; heading < kHeadings; ++heading) {
        const Cell next = step(queue_[i], heading);
        if (next == kNowhere || !isCore(next) || seen_[next] == search_) continue;
        if (next == from) {
          if (queue_[i] != to) return true;
          continue;
        }
        seen_[next] = search_;
        queue_.push_back(next);
      }
    }
    return false;
  }

  const Floor& floor_;
  std::vector<Cell> core_, queue_;
  std::vector<int> seen_;
  int search_ = 0;
};

}  // namespace

std::vector<LayoutFault> checkLayout(const Floor& floor) { return Aisles(floor).faults(); }

namespace {

std::string at(Cell cell, const Floor& floor, const Raster& raster) {
  std::ostringstream text;
  text << "(" << raster.x + floor.x(cell) * raster.spacing << ", "
       << raster.y + floor.y(cell) * raster.spacing << ")";
  return text.str();
}

}  // namespace

std::string describe(const LayoutFault& fault, const Floor& floor, const Raster& raster) {
  if (fault.kind == Kind::kNoAisles) return "there is no aisle for a loaded robot to drive on";
  constexpr std::size_t kNamed = 10;
  const std::size_t each = fault.kind == Kind::kDeadEnd ? 2 : 1;
  std::string cells;
  for (std::size_t i = 0; i < std::min(fault.cells.size(), kNamed * each); i += each) {
    cells += (i > 0 ? ", " : "") + at(fault.cells[i], floor, raster);
    if (each == 2) cells += " to " + at(fault.cells[i + 1], floor, raster);
  }
  const std::size_t more = fault.cells.size() / each;
  if (more > kNamed) cells += " and " + std::to_string(more - kNamed) + " more";
  if (fault.kind == Kind::kCutOff) {
    return "no loaded robot can drive there and back to the other aisles: " + cells;
  }
  return "two robots that meet could not pass each other (no cycle of three cells or more): " +
         cells;
}

}  // namespace layout
