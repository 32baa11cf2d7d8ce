// SPDX-License-Identifier: Apache-2.0
//
// The distance to a goal from every cell and heading, one table a goal and deck. On a floor of
// moderate size a table has all cells. On a larger one it has the cells around its goal; beyond
// them all goals of a region share the table of the region's middle. Tables are made on demand, on
// all threads. The least recently used table is dropped first.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <list>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/floor/cell_numbers.h"
#include "core/floor/distance_search.h"
#include "core/floor/regions.h"
#include "core/parallel/threads.h"

namespace fleet {

/// Costs to one goal. A cell has 32 bits: 16 for the cheapest heading, and four for the extra cost
/// of each other heading, at most 15. A turn in place is at most half a circle, which costs 12 if a
/// quarter costs a tick.
/// A near table has the cells around its goal. Outside of them, the cost is that of the far table,
/// to the region's middle, plus the largest cost from the middle to the goal. No cell of the near
/// table has a larger cost than by the middle. So from everywhere some action leads nearer to the
/// goal, and a robot can't get stuck where the two tables meet.
class DistanceTable {
 public:
  int at(Cell cell, int heading) const {
    const int index = indexOf(cell);
    return index < 0 ? far_->at(cell, heading) + detour_ : costAt(index, heading);
  }
  bool reaches(Cell cell) const {
    const int index = indexOf(cell);
    return index < 0 ? far_->reaches(cell) : words_[index] >> 16 != kUnreachable;
  }

 private:
  friend class DistanceTables;
  int costAt(int index, int heading) const {
    const std::uint32_t word = words_[index];
    return static_cast<int>(word >> 16) + static_cast<int>(word >> (4 * heading) & 0xf);
  }
  /// Returns the index of a cell's word; -1 beyond the window.
  int indexOf(Cell cell) const {
    if (far_ == nullptr) return numbers_ == nullptr ? cell : numbers_[cell];
    const auto y = static_cast<int>(static_cast<std::uint64_t>(cell) * inverse_ >> kInverseBits);
    const int column = cell - y * width_ - window_.left, row = y - window_.top;
    const bool is_inside = static_cast<unsigned>(column) < static_cast<unsigned>(window_.columns) &&
                           static_cast<unsigned>(row) < static_cast<unsigned>(window_.rows);
    return is_inside ? row * window_.columns + column : -1;
  }
  /// Restricts the table to the cells of a window.
  void enclose(const Floor& floor, const Window& window, const DistanceTable& far, int detour);

  /// The inverse of the floor's width: multiplying by it replaces a division. Exact for 2^20
  /// columns and 2^20 rows.
  static constexpr int kInverseBits = 40;
  std::vector<std::uint32_t> words_;
  const std::int32_t* numbers_ = nullptr;  ///< index of a word by cell; nullptr: the cell itself
  const DistanceTable* far_ =
      nullptr;      ///< table for cells beyond the window; nullptr: all cells are here
  int detour_ = 0;  ///< added to costs of the far table
  Window window_;
  std::uint64_t inverse_ = 0;
  int width_ = 0;
  int version_ = 0;  ///< version of the edges
  int made_ = 0;     ///< time at which it was made
};

struct TableOptions {
  int turn_ticks = 1;     ///< cost of a quarter turn, up to kMaxTurnTicks
  std::size_t bytes = 0;  ///< largest size of all tables
  Cell whole_up_to = 0;   ///< largest floor on which each table has all cells; on one up to eight
                          ///< times as large, tables to goals in lanes still have
};

class DistanceTables {
 public:
  DistanceTables(const Floor& floor, const Edges& edges, const TableOptions& options,
                 const Threads& threads);

  /// Begins a step at time `now`, with edges of that version. New tables of the step may have
  /// `work` states (cells and headings) in all; one table is always allowed.
  void begin(int now, int version, std::int64_t work);

  /// Takes the present costs of edges. Steps with edges of another version do so implicitly.
  void reprice() { prices_.update(edges_); }

  /// Notes that a robot needs this table in this step, so that it is made if it is missing.
  void need(Deck deck, Cell goal);
  /// Makes the missing tables, on all threads.
  void make();

  /// Returns the table for a robot in the cell `from`, perhaps an outdated one; nullptr if there is
  /// none. `is_urgent`: the robot makes no progress.
  const DistanceTable* find(Deck deck, Cell from, Cell goal, bool is_urgent);

  /// Renews tables used in this step that are older than `max_age` or made with earlier edges, the
  /// urgent and the oldest first. `work` limits their states; new tables of the step count against
  /// it, but `least` states are always allowed.
  void renew(int max_age, std::int64_t work, std::int64_t least);

  /// Makes the tables of all regions ahead of need, while `goes_on` returns true and there is room.
  void prepare(const std::function<bool()>& goes_on);

  /// Writes or reads the tables of regions. Throws std::runtime_error with the reason, such as
  /// tables of another floor.
  void save(std::ostream& out) const;
  void load(std::istream& in);
  /// Does the same with the file at a path, which errors name.
  void save(const std::string& path) const;
  void load(const std::string& path);

  bool hasRegions() const { return regions_ != nullptr; }
  /// Returns whether a table around either cell contains the other cell.
  bool areNear(Cell cell, Cell other) const;
  std::size_t bytes() const { return used_; }
  int count() const { return static_cast<int>(tables_.size()); }

 private:
  enum class Kind : std::uint8_t { kWhole, kNear, kFar };
  struct Entry {
    std::int64_t key = 0;
    Kind kind = Kind::kWhole;
    Deck deck = Deck::kUnder;
    Cell goal = kNowhere;
    Entry* far = nullptr;  ///< the far table of a near one
    int far_made = -1;     ///< time at which the far table was made
    std::size_t bytes = 0;
    bool is_made = false;
    int needed = -1;  ///< time of the last need()
    int asked = -1;   ///< time of the last find()
    bool is_urgent = false;
    std::list<Entry>::iterator self;
    DistanceTable table;
  };

  static std::int64_t keyOf(Deck deck, Cell goal, bool is_far) {
    return std::int64_t{goal} << 2 | static_cast<int>(deck) << 1 | static_cast<int>(is_far);
  }
  Entry* known(std::int64_t key) const;
  Entry* create(Kind kind, Deck deck, Cell goal);
  Entry* needed(Kind kind, Deck deck, Cell goal);
  Cell middleFor(Deck deck, Cell goal) const;
  bool hasRoom(std::size_t bytes);
  bool takesWork(std::int64_t states);
  int cells(Kind kind, Cell goal) const;
  /// Returns the reach of a near table in columns and rows from its goal: beyond the middle of its
  /// region in any case.
  int reach() const { return regions_->side() * 3 / 2; }
  /// Returns the reach of the table to a goal. In a lane the middle may be a neighbouring region's.
  int reach(Cell goal) const { return floor_.isLane(goal) ? regions_->side() * 5 / 2 : reach(); }
  void touch(Entry& entry);
  void ask(Entry& entry, bool is_urgent);
  std::vector<Entry*> chooseOutdated(int max_age);
  void build(const std::vector<Entry*>& entries);
  void buildAll(const std::vector<Entry*>& entries);
  void search(Entry& entry, DistanceSearch& search) const;
  void searchNear(Entry& entry, DistanceSearch& search) const;
  void pack(const DistanceSearch& search, DistanceTable& table) const;
  bool isClosed(Deck deck, Cell cell) const;
  std::string heading() const;

  const Floor& floor_;
  const Edges& edges_;
  Prices prices_;
  const TableOptions options_;
  const Threads& threads_;
  std::unique_ptr<Regions> regions_;  ///< nullptr: every table has all cells
  std::unique_ptr<CellNumbers>
      numbers_;              ///< nullptr: a table of all cells has a word for each of them
  std::size_t used_ = 0;     ///< bytes
  std::list<Entry> tables_;  ///< the most recently needed first
  std::unordered_map<std::int64_t, Entry*> index_;
  std::vector<Entry*> to_make_, asked_;                    ///< in this step
  std::vector<std::unique_ptr<DistanceSearch>> searches_;  ///< one a thread
  int now_ = 0, version_ = 0;
  std::int64_t work_ = 0;  ///< states that the step may still compute
  bool has_worked_ = false;
};

}  // namespace fleet
