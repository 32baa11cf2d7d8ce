// SPDX-License-Identifier: Apache-2.0
#include "core/floor/distance_tables.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace fleet {
namespace {

constexpr int kLeastSide = 12, kMostSide = 32;  // side of a region [cells]

bool hasStorage(const Floor& floor) {
  for (Cell cell = 0; cell < floor.size(); ++cell) {
    if (floor.isStorage(cell)) return true;
  }
  return false;
}

/// Returns the smallest side for which the tables of all regions, of `words` words each, fit into
/// half of the memory limit.
int sideFor(const Floor& floor, int words, std::size_t bytes) {
  const std::size_t table = words * sizeof(std::uint32_t) * (hasStorage(floor) ? 2 : 1);
  int side = kLeastSide;
  while (side < kMostSide && table * Regions::count(floor, side) > bytes / 2) side += 4;
  return side;
}

}  // namespace

DistanceTables::DistanceTables(const Floor& floor, const Edges& edges, const TableOptions& options,
                               const Threads& threads)
    : floor_(floor), edges_(edges), options_(options), threads_(threads) {
  if (floor.size() > options.whole_up_to) {
    numbers_ = numbered(floor);
    const int words = numbers_ == nullptr ? floor.size() : numbers_->words();
    regions_ = std::make_unique<Regions>(floor, sideFor(floor, words, options.bytes));
  }
  prices_.update(edges);
  for (int thread = 0; thread < threads.count(); ++thread) {
    searches_.push_back(
        std::make_unique<DistanceSearch>(floor, edges, prices_, options.turn_ticks));
  }
}

void DistanceTables::begin(int now, int version, std::int64_t work) {
  now_ = now;
  work_ = work;
  has_worked_ = false;
  if (std::exchange(version_, version) != version) reprice();
  asked_.clear();
  to_make_.clear();
}

void DistanceTables::need(Deck deck, Cell goal) {
  Entry* entry = known(keyOf(deck, goal, false));
  if (entry == nullptr) {
    const Cell middle = middleFor(deck, goal);
    const Kind kind = middle == kNowhere ? Kind::kWhole : Kind::kNear;
    Entry* far = kind == Kind::kNear ? needed(Kind::kFar, deck, middle) : nullptr;
    if (kind == Kind::kNear && far == nullptr) return;
    entry = create(kind, deck, goal);
    if (entry == nullptr) return;
    entry->far = far;
  }
  touch(*entry);
  if (entry->far != nullptr) touch(*entry->far);  // a far table outlives the near ones that need it
}

/// Returns a table, and creates it if it is missing.
DistanceTables::Entry* DistanceTables::needed(Kind kind, Deck deck, Cell goal) {
  Entry* entry = known(keyOf(deck, goal, kind == Kind::kFar));
  if (entry == nullptr) entry = create(kind, deck, goal);
  if (entry != nullptr) touch(*entry);
  return entry;
}

void DistanceTables::touch(Entry& entry) {
  tables_.splice(tables_.begin(), tables_, entry.self);
  if (std::exchange(entry.needed, now_) == now_) return;
  const bool is_stale = entry.far != nullptr && entry.far_made != entry.far->table.made_;
  if (!entry.is_made || is_stale) to_make_.push_back(&entry);
}

DistanceTables::Entry* DistanceTables::known(std::int64_t key) const {
  const auto known = index_.find(key);
  return known == index_.end() ? nullptr : known->second;
}

/// Returns the cell whose table serves a goal from far away; kNowhere if the goal has a table of
/// all cells. Few cells in lanes are goals of many robots, so that these have one, except on the
/// largest floors, where a table for each station would take too much time and memory.
Cell DistanceTables::middleFor(Deck deck, Cell goal) const {
  constexpr int kLarge = 8;
  if (regions_ == nullptr) return kNowhere;
  if (!floor_.isLane(goal)) return regions_->middle(deck, regions_->of(goal));
  if (floor_.size() <= kLarge * options_.whole_up_to) return kNowhere;
  return regions_->nearestMiddle(deck, goal);
}

int DistanceTables::cells(Kind kind, Cell goal) const {
  if (kind == Kind::kNear) return around(floor_, goal, reach(goal)).size();
  return numbers_ == nullptr ? floor_.size() : numbers_->words();
}

DistanceTables::Entry* DistanceTables::create(Kind kind, Deck deck, Cell goal) {
  const int cells = this->cells(kind, goal);
  const std::size_t bytes = cells * sizeof(std::uint32_t) + sizeof(Entry);
  if (!takesWork(std::int64_t{cells} * kHeadings) || !hasRoom(bytes)) return nullptr;
  Entry& entry = tables_.emplace_front();
  entry.self = tables_.begin();
  entry.key = keyOf(deck, goal, kind == Kind::kFar);
  entry.kind = kind;
  entry.deck = deck;
  entry.goal = goal;
  entry.bytes = bytes;
  used_ += bytes;
  index_[entry.key] = &entry;
  return &entry;
}

/// Returns whether the step's work allows another table; the first one is always allowed.
bool DistanceTables::takesWork(std::int64_t states) {
  if (has_worked_ && states > work_) return false;
  has_worked_ = true;
  work_ -= states;
  return true;
}

/// Makes room by dropping the tables that were not needed for longest, but none that a robot needs
/// now. Returns whether there is enough.
bool DistanceTables::hasRoom(std::size_t bytes) {
  while (!tables_.empty() && used_ + bytes > options_.bytes) {
    const Entry& last = tables_.back();
    if (last.needed >= 0 && last.needed >= now_ - 1) return false;
    used_ -= last.bytes;
    index_.erase(last.key);
    tables_.pop_back();
  }
  return true;
}

void DistanceTables::make() {
  buildAll(to_make_);
  to_make_.clear();
}

const DistanceTable* DistanceTables::find(Deck deck, Cell from, Cell goal, bool is_urgent) {
  Entry* entry = known(keyOf(deck, goal, false));
  if (entry == nullptr || !entry->is_made) {
    // The region's table serves as well from far away.
    const Cell middle = areNear(from, goal) ? kNowhere : middleFor(deck, goal);
    entry = middle == kNowhere ? nullptr : known(keyOf(deck, middle, true));
    if (entry == nullptr || !entry->is_made) return nullptr;
  }
  ask(*entry, is_urgent);
  if (entry->far != nullptr) ask(*entry->far, is_urgent);
  return &entry->table;
}

bool DistanceTables::areNear(Cell cell, Cell other) const {
  const int reach = regions_ == nullptr ? floor_.size() : this->reach();
  return std::abs(floor_.x(cell) - floor_.x(other)) <= reach &&
         std::abs(floor_.y(cell) - floor_.y(other)) <= reach;
}

void DistanceTables::ask(Entry& entry, bool is_urgent) {
  const bool is_first = std::exchange(entry.asked, now_) != now_;
  if (is_first) asked_.push_back(&entry);
  entry.is_urgent = is_urgent || (!is_first && entry.is_urgent);
}

void DistanceTables::renew(int max_age, std::int64_t work, std::int64_t least) {
  work_ = std::max(least, std::min(work, work_));
  has_worked_ = false;
  buildAll(chooseOutdated(max_age));
}

/// Near tables are renewed with the far table that they extend.
std::vector<DistanceTables::Entry*> DistanceTables::chooseOutdated(int max_age) {
  std::unordered_map<const Entry*, std::vector<Entry*>> near;
  std::vector<Entry*> old;
  for (Entry* entry : asked_) {
    if (entry->far != nullptr) near[entry->far].push_back(entry);
    const bool is_young = entry->table.version_ == version_ && now_ - entry->table.made_ < max_age;
    if (!is_young) old.push_back(entry);
  }
  const auto turn = [](const Entry* entry) {
    return std::make_tuple(!entry->is_urgent, entry->table.made_, entry->key);
  };
  std::sort(old.begin(), old.end(),
            [&](const Entry* entry, const Entry* other) { return turn(entry) < turn(other); });
  std::vector<Entry*> chosen;
  std::unordered_map<const Entry*, bool> is_chosen;
  const auto choose = [&](Entry* entry) {
    if (!std::exchange(is_chosen[entry], true)) chosen.push_back(entry);
  };
  for (Entry* entry : old) {
    if (is_chosen[entry]) continue;
    std::int64_t states = std::int64_t{cells(entry->kind, entry->goal)} * kHeadings;
    const std::vector<Entry*>& goals = near[entry];
    for (const Entry* goal : goals)
      states += std::int64_t{cells(goal->kind, goal->goal)} * kHeadings;
    if (!takesWork(states)) break;
    choose(entry);
    for (Entry* goal : goals) choose(goal);
  }
  return chosen;
}

void DistanceTables::prepare(const std::function<bool()>& goes_on) {
  if (regions_ == nullptr) return;
  const int batch = 4 * threads_.count();
  std::vector<Entry*> entries;
  for (const Deck deck : {Deck::kUnder, Deck::kAisles}) {
    if (deck == Deck::kAisles && !hasStorage(floor_)) continue;
    for (int region = 0; region < regions_->size() && goes_on(); ++region) {
      const Cell middle = regions_->middle(deck, region);
      if (middle == kNowhere || known(keyOf(deck, middle, true)) != nullptr) continue;
      has_worked_ = false;
      Entry* entry = create(Kind::kFar, deck, middle);
      if (entry == nullptr) break;
      entries.push_back(entry);
      if (static_cast<int>(entries.size()) < batch) continue;
      build(std::exchange(entries, {}));
    }
  }
  build(entries);
}

}  // namespace fleet
