// SPDX-License-Identifier: Apache-2.0
//
// How far it is to a goal from every cell and heading: one table a goal and deck, made when it is
// asked for by Dijkstra's algorithm from the goal backwards, and dropped when it was not asked for
// the longest.
#pragma once

#include <cstdint>
#include <list>
#include <unordered_map>
#include <vector>

#include "guidance.h"
#include "warehouse_fleet/floor.h"

namespace fleet {

constexpr int kUnreachable = 0xffff;
constexpr int kMaxTurnTicks = 2;

/// Costs to one goal. 32 bits a cell: 16 for the heading from which it is nearest, four for what
/// each of the others is farther, at most 15: a turn in place is never worse than half a circle,
/// which takes 12 if a quarter costs a tick.
class DistanceTable {
 public:
  int at(Cell cell, int heading) const {
    const std::uint32_t word = words_[cell];
    return static_cast<int>(word >> 16) + static_cast<int>(word >> (4 * heading) & 0xf);
  }
  bool reaches(Cell cell) const { return words_[cell] >> 16 != kUnreachable; }

 private:
  friend class DistanceTables;
  std::vector<std::uint32_t> words_;
  int version_ = 0;  ///< of the edges that it was made for
  int made_ = 0;     ///< when
};

/// Edges as they are now: what is closed taken away, and what each costs.
struct Edges {
  std::vector<Cell> next[2];  ///< by deck; by cell and heading
  const std::vector<std::uint8_t>* costs;
  std::vector<std::uint8_t> is_tight;  ///< by cell: a load can't be turned there; empty: nowhere

  bool mayTurnEverywhere(Deck deck) const { return deck == Deck::kUnder || is_tight.empty(); }
  bool mayTurn(Deck deck, Cell cell) const { return mayTurnEverywhere(deck) || !is_tight[cell]; }
};

class DistanceTables {
 public:
  /// A quarter turn costs `turn_ticks`, up to kMaxTurnTicks. Keeps at most `bytes` of tables, but
  /// for one.
  DistanceTables(const Floor& floor, const Edges& edges, int turn_ticks, std::size_t bytes);

  /// A step begins: at that time, with edges of that version. So many tables may be made in it.
  void begin(int now, int version, int builds);

  /// The table, perhaps an outdated one; nullptr if it is not there and no more may be made now. It
  /// is urgent to who does not get on with it.
  const DistanceTable* find(Deck deck, Cell goal, bool is_urgent);

  /// Renews at most so many of the tables that were asked for in this step, the urgent and the
  /// oldest first, that are older than `max_age` or of earlier edges.
  void renew(int max_age, int builds);

  std::size_t bytes() const { return tables_.size() * tableBytes(); }

 private:
  struct Entry {
    std::int64_t key;
    DistanceTable table;
    int asked = -1;  ///< when it was asked for last
    bool is_urgent = false;
  };

  std::size_t tableBytes() const { return floor_.size() * sizeof(std::uint32_t); }
  void ask(Entry& entry, bool is_urgent);
  void build(Entry& entry);
  void push(int state, int cost);
  void relax(Deck deck, Cell goal, int state);
  void pack(DistanceTable& table) const;

  const Floor& floor_;
  const Edges& edges_;
  const int turn_cost_;
  const std::size_t capacity_;
  std::list<Entry> tables_;  ///< what was asked for last comes first
  std::unordered_map<std::int64_t, std::list<Entry>::iterator> index_;
  std::vector<Entry*> asked_;  ///< in this step
  int now_ = 0, version_ = 0, builds_ = 0;
  // Of the search: costs by cell and heading, and a ring of queues, one a cost.
  std::vector<std::uint16_t> cost_;
  std::vector<std::vector<std::int32_t>> queues_;
};

}  // namespace fleet
