// SPDX-License-Identifier: Apache-2.0
//
// How far it is to a goal from every cell and heading, one table a goal and deck. On a floor of
// moderate size a table has all cells. On a larger one it has the cells around its goal; beyond
// them all goals of a region share the table of the region's middle. Tables are made when they are
// asked for, on all threads, and dropped when they were not asked for the longest.
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

/// Costs to one goal. 32 bits a cell: 16 for the heading from which it is nearest, four for what
/// each of the others is farther, at most 15: a turn in place is never worse than half a circle,
/// which takes 12 if a quarter costs a tick.
///
/// A table of the cells around its goal adds to the far table what it costs at most to get from the
/// region's middle to the goal, and has no more than that in any cell of its own. So from anywhere
/// some action leads to where it is nearer: nothing to get stuck in where the two meet.
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
  /// Of its words; -1 beyond its window.
  int indexOf(Cell cell) const {
    if (far_ == nullptr) return numbers_ == nullptr ? cell : numbers_[cell];
    const auto y = static_cast<int>(static_cast<std::uint64_t>(cell) * inverse_ >> kInverseBits);
    const int column = cell - y * width_ - window_.left, row = y - window_.top;
    const bool is_inside = static_cast<unsigned>(column) < static_cast<unsigned>(window_.columns) &&
                           static_cast<unsigned>(row) < static_cast<unsigned>(window_.rows);
    return is_inside ? row * window_.columns + column : -1;
  }
  /// Has it hold the cells of a window alone.
  void enclose(const Floor& floor, const Window& window, const DistanceTable& far, int detour);

  /// Dividing by the floor's width is multiplying by its inverse: exact for 2^20 columns and 2^20
  /// rows.
  static constexpr int kInverseBits = 40;
  std::vector<std::uint32_t> words_;
  const std::int32_t* numbers_ = nullptr;  ///< of its words, by cell; nullptr: the cells' own
  const DistanceTable* far_ = nullptr;     ///< for cells beyond its window; nullptr: it has all
  int detour_ = 0;                         ///< to be added to what that says
  Window window_;
  std::uint64_t inverse_ = 0;
  int width_ = 0;
  int version_ = 0;  ///< of the edges that it was made for
  int made_ = 0;     ///< when
};

struct TableOptions {
  int turn_ticks = 1;     ///< what a quarter turn costs, up to kMaxTurnTicks
  std::size_t bytes = 0;  ///< of tables kept, at most
  Cell whole_up_to = 0;   ///< cells of a floor each of whose tables has all cells; of one eight
                          ///< times as large those to goals in lanes still have
};

class DistanceTables {
 public:
  DistanceTables(const Floor& floor, const Edges& edges, const TableOptions& options,
                 const Threads& threads);

  /// A step begins: at that time, with edges of that version. New tables may have so many states
  /// (cells and headings) in it, at least one table.
  void begin(int now, int version, std::int64_t work);

  /// Takes in what edges cost by now; steps with edges of another version do so by themselves.
  void reprice() { prices_.update(edges_); }

  /// A robot needs this table in this step: it will be made if there is none.
  void need(Deck deck, Cell goal);
  /// Makes what was needed, on all threads.
  void make();

  /// Returns the table for a robot in the cell `from`, perhaps an outdated one; nullptr if it is
  /// not there. It is urgent to a robot that makes no progress.
  const DistanceTable* find(Deck deck, Cell from, Cell goal, bool is_urgent);

  /// Renews some of the tables that were found in this step, of so many states, or fewer where new
  /// tables took much of the step: the urgent and the oldest first, that are older than `max_age`
  /// or of earlier edges.
  void renew(int max_age, std::int64_t work);

  /// Makes the tables of all regions ahead of need, as long as `goes_on` says so and there is room.
  void prepare(const std::function<bool()>& goes_on);

  /// Writes the tables of regions; or reads them. Throws std::runtime_error that says what is
  /// wrong, for example that they were made for another floor.
  void save(std::ostream& out) const;
  void load(std::istream& in);
  /// The same with the file at a path, which what is thrown names.
  void save(const std::string& path) const;
  void load(const std::string& path);

  bool hasRegions() const { return regions_ != nullptr; }
  /// Returns whether one of two cells is among those that a table around the other has.
  bool areNear(Cell one, Cell other) const;
  std::size_t bytes() const { return used_; }
  int count() const { return static_cast<int>(tables_.size()); }

 private:
  enum class Kind : std::uint8_t { kWhole, kNear, kFar };
  struct Entry {
    std::int64_t key = 0;
    Kind kind = Kind::kWhole;
    Deck deck = Deck::kUnder;
    Cell goal = kNowhere;
    Entry* far = nullptr;  ///< of a near table
    int far_made = -1;     ///< when that was made
    std::size_t bytes = 0;
    bool is_made = false;
    int needed = -1;  ///< when it was needed last
    int asked = -1;   ///< when it was asked for last
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
  /// How many columns and rows from its goal a table ends that has a far one: behind the middle of
  /// its region, wherever that is.
  int reach() const { return regions_->side() * 3 / 2; }
  /// The same of a table to a goal: from a lane the middle may be that of a region beside it.
  int reach(Cell goal) const { return floor_.isLane(goal) ? regions_->side() * 5 / 2 : reach(); }
  void touch(Entry& entry);
  void ask(Entry& entry, bool is_urgent);
  std::vector<Entry*> chooseOutdated(int max_age, std::int64_t work);
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
  std::unique_ptr<Regions> regions_;      ///< nullptr: each table has all cells
  std::unique_ptr<CellNumbers> numbers_;  ///< nullptr: tables of all cells have a word for each
  std::size_t used_ = 0;                  ///< bytes
  std::list<Entry> tables_;               ///< what was needed last comes first
  std::unordered_map<std::int64_t, Entry*> index_;
  std::vector<Entry*> to_make_, asked_;                    ///< in this step
  std::vector<std::unique_ptr<DistanceSearch>> searches_;  ///< one a thread
  int now_ = 0, version_ = 0;
  std::int64_t work_ = 0;  ///< that may still be done in this step
  bool has_worked_ = false;
};

}  // namespace fleet
