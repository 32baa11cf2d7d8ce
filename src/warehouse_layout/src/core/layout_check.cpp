// SPDX-License-Identifier: Apache-2.0
#include "warehouse_layout/layout_check.h"

#include <algorithm>
#include <sstream>

#include "warehouse_layout/strong_bridges.h"

namespace layout {
namespace {

using Kind = LayoutFault::Kind;

/// The aisles' deck, searched along its edges and against them.
class Aisles {
 public:
  explicit Aisles(const Floor& floor) : floor_(floor), index_(floor.size(), kNowhere) {
    for (Cell cell = 0; cell < floor.size(); ++cell) {
      if (!isCore(cell)) continue;
      index_[cell] = static_cast<Cell>(core_.size());
      core_.push_back(cell);
    }
    ahead_ = back_ = Neighbours(core_.size(), {kNowhere, kNowhere, kNowhere, kNowhere});
    for (const Cell cell : core_) {
      for (int heading = 0; heading < kHeadings; ++heading) join(cell, heading);
    }
    part_ = strongParts(ahead_, back_);
  }

  std::vector<LayoutFault> faults() const {
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

  void join(Cell cell, int heading) {
    const Cell to = step(cell, heading);
    if (to == kNowhere || !isCore(to)) return;
    ahead_[index_[cell]][heading] = index_[to];
    back_[index_[to]][heading] = index_[cell];
  }

  /// Returns core cells that are not strongly connected with the others, and storage places and
  /// lane cells without a way to them and back.
  std::vector<Cell> cutOff() const {
    const std::vector<Cell> start = largestPart();
    const auto ahead = reached(start, true), back = reached(start, false);
    std::vector<Cell> cells;
    for (Cell cell = 0; cell < floor_.size(); ++cell) {
      if (floor_.isPassable(cell) && !(ahead[cell] && back[cell])) cells.push_back(cell);
    }
    return cells;
  }

  /// Returns the cells of the largest strongly connected part of the core.
  std::vector<Cell> largestPart() const {
    std::vector<int> size(core_.size(), 0);
    for (const int part : part_) ++size[part];
    int best = part_.front();
    for (const int part : part_) {
      if (size[part] > size[best]) best = part;
    }
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < core_.size(); ++i) {
      if (part_[i] == best) cells.push_back(core_[i]);
    }
    return cells;
  }

  /// Returns the cells with a way from core cells, or to them: first over the core alone, then into
  /// lanes and storage places.
  std::vector<std::uint8_t> reached(const std::vector<Cell>& start, bool is_forward) const {
    std::vector<std::uint8_t> reached(floor_.size(), 0);
    std::vector<Cell> queue = start;
    for (const Cell cell : start) reached[cell] = 1;
    spread(is_forward, true, &queue, &reached);
    spread(is_forward, false, &queue, &reached);
    return reached;
  }

  void spread(bool is_forward, bool core_only, std::vector<Cell>* queue,
              std::vector<std::uint8_t>* reached) const {
    for (std::size_t i = 0; i < queue->size(); ++i) {
      const Cell cell = (*queue)[i];
      for (int heading = 0; heading < kHeadings; ++heading) {
        const Cell to = is_forward ? step(cell, heading) : stepBack(cell, heading);
        if (to == kNowhere || (*reached)[to]) continue;
        // A way must not pass a lane, either: robots that only pass would wait in its queue.
        if (isCore(to) != core_only) continue;
        // Loaded robots neither pass storage places nor need to reach parking places.
        if (floor_.isStorage(cell) && floor_.isStorage(to) && !floor_.isParking(to)) continue;
        (*reached)[to] = 1;
        queue->push_back(to);
      }
    }
  }

  Cell step(Cell cell, int heading) const { return floor_.next(Deck::kUnder, cell, heading); }

  Cell stepBack(Cell cell, int heading) const {
    const Cell from = floor_.beside(cell, heading + 2);
    return from != kNowhere && step(from, heading) == cell ? from : kNowhere;
  }

  std::vector<Cell> deadEnds() const {
    const StrongBridges bridges(ahead_, back_, part_);
    std::vector<Cell> cells;
    for (Cell from = 0; from < static_cast<Cell>(core_.size()); ++from) {
      for (const Cell to : ahead_[from]) {
        if (to == kNowhere || leadsBack(from, to, bridges)) continue;
        cells.push_back(core_[from]);
        cells.push_back(core_[to]);
      }
    }
    return cells;
  }

  /// Returns whether there is a way from `to` to `from`, both indices, besides the one edge.
  bool leadsBack(Cell from, Cell to, const StrongBridges& bridges) const {
    return part_[from] == part_[to] && !bridges.has(to, from);
  }

  const Floor& floor_;
  std::vector<Cell> core_;   // cells
  std::vector<Cell> index_;  // into core_, of each cell
  Neighbours ahead_, back_;  // indices into core_
  std::vector<int> part_;    // part of each cell in core_
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
