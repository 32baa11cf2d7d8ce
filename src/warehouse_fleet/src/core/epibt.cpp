// SPDX-License-Identifier: Apache-2.0
#include "warehouse_fleet/epibt.h"

#include <time.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <tuple>

#include "candidates.h"
#include "distance_tables.h"
#include "guidance.h"
#include "making_way.h"
#include "reservations.h"
#include "spacing.h"

namespace fleet {
namespace {

double threadSeconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return now.tv_sec + 1e-9 * now.tv_nsec;
}

void inRange(const char* name, int value, int least, int most) {
  if (value >= least && value <= most) return;
  throw FloorError(std::string(name) + " " + std::to_string(value) + "; " + std::to_string(least) +
                   " to " + std::to_string(most) + " was expected");
}

/// What is remembered of a robot from step to step.
struct Memory {
  Cell goal = kNowhere;
  int waiting = 0;  ///< ticks since it was given its goal, or reached it
  State planned;    ///< where its path begins
  Deck deck = Deck::kUnder;
};

class Epibt : public Planner {
 public:
  explicit Epibt(const EpibtOptions& options) : options_(options) {
    if (options_.horizon == 0) options_.horizon = options_.depth;
    inRange("depth", options_.depth, 1, kMaxDepth);
    inRange("horizon", options_.horizon, options_.depth, kMaxHorizon);
    inRange("turn_ticks", options_.turn_ticks, 1, kMaxTurnTicks);
  }

  void start(const Floor& floor, const Rules& rules, std::uint64_t seed) override;
  void plan(const Fleet& fleet, const Budget& budget, Plan& plan) override;

 private:
  void observe(const Fleet& fleet);
  void close(const Fleet& fleet);
  void closeDeck(Deck deck, std::vector<Cell> cells);
  void tighten(const std::vector<Cell>& cells);
  void wish(const Fleet& fleet);
  void inherit(const Fleet& fleet);
  void resume(const std::vector<Path>& rests);
  void prioritise(const Fleet& fleet);
  void nearestFirst(const std::vector<int>& distance, std::vector<int>& key) const;
  void improve(const Budget& budget, double deadline);
  void answer(const Fleet& fleet, Plan& plan);

  /// How an operation is looked for.
  struct Search {
    bool takes_all;  ///< or only what makes all paths together no dearer
    int pushes;      ///< how many more robots may be moved aside
    int rank;        ///< only those of a lower rank; -1: anybody
  };
  bool mayMove(int robot, const Search& search) const;
  bool insert(int robot, std::int64_t gain, Search& search);
  std::int64_t weigh(int robot, const Path& path) const {
    return std::int64_t{weight_[robot]} * path.cost;
  }
  bool replan(int robot, Search search);
  void visit(int robot);

  EpibtOptions options_;
  std::unique_ptr<Edges> edges_;
  std::unique_ptr<Guidance> guidance_;
  std::unique_ptr<DistanceTables> tables_;
  std::unique_ptr<Candidates> candidates_;
  std::unique_ptr<Reservations> reserved_;
  std::unique_ptr<Spacing> spacing_;
  std::unique_ptr<MakingWay> way_;
  Rules rules_;
  const Floor* floor_ = nullptr;
  std::mt19937_64 random_;
  int now_ = 0;
  int version_ = 0;
  std::vector<Cell> closed_[2];  ///< now, by deck, sorted
  std::vector<Cell> tight_;      ///< now
  std::vector<Memory> memory_;
  std::vector<Wish> wishes_;
  std::vector<int> order_, rank_;  ///< who comes first, and who comes when
  std::vector<int> weight_;        ///< of a robot's cost in that of all
  // Of one pass: whom it has come to, how often, and who is being moved right now.
  std::vector<int> searched_, visits_, settled_;
  int pass_ = 0, search_ = 0;
};

void Epibt::start(const Floor& floor, const Rules& rules, std::uint64_t seed) {
  floor_ = &floor;
  random_.seed(seed);
  guidance_ = std::make_unique<Guidance>(
      floor, GuidanceOptions{options_.against, options_.crowd, options_.resting, options_.at_lanes,
                             options_.memory});
  edges_ = std::make_unique<Edges>();
  edges_->next[0] = floor.edges(Deck::kUnder);
  edges_->next[1] = floor.edges(Deck::kAisles);
  edges_->costs = &guidance_->costs();
  tight_.clear();
  tables_ =
      std::make_unique<DistanceTables>(floor, *edges_, options_.turn_ticks, options_.table_bytes);
  candidates_ = std::make_unique<Candidates>(floor, *edges_, options_.depth, options_.horizon);
  reserved_ = std::make_unique<Reservations>(floor, rules, options_.horizon);
  spacing_ = std::make_unique<Spacing>(options_.horizon);
  way_ = std::make_unique<MakingWay>(floor, options_.patience);
  for (auto& closed : closed_) closed.clear();
  rules_ = rules;
}

void Epibt::plan(const Fleet& fleet, const Budget& budget, Plan& plan) {
  const double deadline = threadSeconds() + budget.seconds;
  check(*floor_, fleet);
  observe(fleet);
  close(fleet);
  wish(fleet);
  way_->direct(fleet, *candidates_, wishes_);
  inherit(fleet);
  prioritise(fleet);
  ++pass_;
  for (const int robot : order_) {
    if (settled_[robot] != pass_) replan(robot, {true, options_.pushes, rank_[robot]});
  }
  improve(budget, deadline);
  answer(fleet, plan);
  ++now_;
}

/// Learns from what has become of the last plan.
void Epibt::observe(const Fleet& fleet) {
  if (fleet.size() < static_cast<int>(memory_.size())) memory_.clear();
  memory_.resize(fleet.size());
  for (int robot = 0; robot < fleet.size(); ++robot) {
    Memory& memory = memory_[robot];
    ++memory.waiting;
    if (memory.goal != fleet.goal[robot] || fleet.cell[robot] == memory.goal) memory.waiting = 0;
    memory.goal = fleet.goal[robot];
    if (static_cast<int>(wishes_.size()) <= robot) continue;
    const State& was = wishes_[robot].state;
    if (was.cell != fleet.cell[robot]) {
      guidance_->drove(was.cell, was.heading);
    } else if (was.heading == fleet.heading[robot] && wishes_[robot].goal != kNowhere) {
      guidance_->waited(was.cell);
    }
  }
  guidance_->tick();
  for (int robot = 0; robot < fleet.size(); ++robot) {
    if (fleet.cell[robot] == fleet.goal[robot]) guidance_->rests(fleet.cell[robot]);
  }
  constexpr int kRefresh = 10;
  if (now_ % kRefresh == 0) guidance_->refresh();
}

/// Removes the edges that lead into closed cells, and restores those of cells that are open again.
void Epibt::close(const Fleet& fleet) {
  std::vector<Cell> under = fleet.closed;
  for (int robot = 0; robot < fleet.size(); ++robot) {
    if (fleet.isStopped(robot)) under.push_back(fleet.cell[robot]);
  }
  std::vector<Cell> aisles = under;
  aisles.insert(aisles.end(), fleet.units.begin(), fleet.units.end());
  closeDeck(Deck::kUnder, std::move(under));
  closeDeck(Deck::kAisles, std::move(aisles));
  tighten(fleet.tight);
}

void Epibt::closeDeck(Deck deck, std::vector<Cell> cells) {
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  std::vector<Cell>& closed = closed_[static_cast<int>(deck)];
  if (cells == closed) return;
  auto& next = edges_->next[static_cast<int>(deck)];
  const auto set = [&](const std::vector<Cell>& those, bool is_open) {
    for (const Cell cell : those) {
      for (int heading = 0; heading < kHeadings; ++heading) {
        const Cell from = floor_->beside(cell, heading + 2);
        if (from == kNowhere) continue;
        next[from * kHeadings + heading] = is_open ? floor_->next(deck, from, heading) : kNowhere;
      }
    }
  };
  set(closed, true);
  set(cells, false);
  closed = std::move(cells);
  ++version_;
}

void Epibt::tighten(const std::vector<Cell>& cells) {
  if (cells == tight_) return;
  edges_->is_tight.assign(cells.empty() ? 0 : floor_->size(), 0);
  for (const Cell cell : cells) edges_->is_tight[cell] = 1;
  tight_ = cells;
  ++version_;
}

void Epibt::wish(const Fleet& fleet) {
  const int states = floor_->size() * kHeadings;
  constexpr int kLeastWork = 60000;
  constexpr int kImpatient = 5;  // ticks in a cell after which other ways are looked for
  const auto tables = [&](int work) {
    return std::max(1, std::max(kLeastWork, work * fleet.size()) / states);
  };
  tables_->begin(now_, version_, tables(options_.table_work));
  wishes_.resize(fleet.size());
  for (int robot = 0; robot < fleet.size(); ++robot) {
    Wish& wish = wishes_[robot];
    wish = {};
    wish.state = {fleet.cell[robot], fleet.heading[robot]};
    wish.deck = fleet.deck(robot);
    wish.goal = fleet.goal[robot];
    wish.home = fleet.isLoaded(robot) ? fleet.homeOf(robot) : kNowhere;
    wish.stopped = fleet.isStopped(robot);
    wish.stops_at_goal = options_.goals_are_stops;
    wish.committed = wish.stopped ? 0 : std::min(fleet.commitments(robot), options_.horizon);
    for (int tick = 0; tick < wish.committed; ++tick) {
      wish.commitment[tick] = fleet.commitment(robot, tick);
    }
    if (wish.goal == kNowhere || wish.stopped) continue;
    const bool waits = way_->still(robot) >= kImpatient && !floor_->isLane(wish.state.cell);
    wish.table = tables_->find(wish.deck, wish.goal, waits);
    if (wish.table == nullptr || wish.table->reaches(wish.state.cell)) continue;
    tables_->find(wish.deck, wish.goal, true);  // perhaps there is a way by now
    wish.goal = kNowhere;
  }
  tables_->renew(options_.renewal_age, tables(options_.renewal_work));
  candidates_->begin(fleet.size());
}

/// Everybody begins with what is left of the last plan, if it still can be driven.
void Epibt::inherit(const Fleet& fleet) {
  std::vector<Path> rests(fleet.size());
  bool all_as_planned = true;
  for (int robot = 0; robot < fleet.size(); ++robot) {
    const Wish& wish = wishes_[robot];
    const Memory& memory = memory_[robot];
    bool is_as_planned = false, is_known = false;
    if (memory.planned.cell != kNowhere && memory.deck == wish.deck) {
      const Path& path = reserved_->path(robot);
      rests[robot] = candidates_->rest(path, memory.planned, wish, is_as_planned);
      is_known = candidates_->canDrive(rests[robot], wish);
    }
    if (!is_known) rests[robot] = candidates_->standing(wish);
    if (!is_known || !is_as_planned) all_as_planned = false;
  }
  reserved_->begin(fleet);
  if (!all_as_planned) return resume(rests);
  for (int robot = 0; robot < fleet.size(); ++robot) reserved_->place(robot, rests[robot]);
}

/// Has all robots stand but the committed ones; a robot that blocks no other takes up its path
/// again.
void Epibt::resume(const std::vector<Path>& rests) {
  const int robots = static_cast<int>(rests.size());
  for (const bool is_committed : {true, false}) {
    for (int robot = 0; robot < robots; ++robot) {
      if ((wishes_[robot].committed > 0) != is_committed) continue;
      const Path standing = candidates_->standing(wishes_[robot]);
      const bool can_stand = reserved_->conflict(robot, standing) == Reservations::kNobody;
      reserved_->place(robot, can_stand ? standing : rests[robot]);
    }
  }
  std::vector<int> waiting(robots), still;
  std::iota(waiting.begin(), waiting.end(), 0);
  do {
    still.clear();
    for (const int robot : waiting) {
      const Path standing = reserved_->path(robot);
      reserved_->remove(robot);
      const bool is_free = reserved_->conflict(robot, rests[robot]) == Reservations::kNobody;
      reserved_->place(robot, is_free ? rests[robot] : standing);
      if (!is_free) still.push_back(robot);
    }
    waiting.swap(still);
  } while (waiting.size() < still.size());
}

/// Who is nearest to its goal goes first, which serves throughput; what a robot has waited counts
/// against what it has still to go, so that no robot waits for ever. A robot that stands for long
/// counts it manifold: beside a stream of robots that have waited elsewhere it would never be let
/// in.
void Epibt::prioritise(const Fleet& fleet) {
  constexpr int kWaitingWorth = 2;    // of kTickCost, a tick
  constexpr int kStandingWorth = 24;  // the same, of those after the first
  constexpr int kStands = 8;          // ticks in a cell
  constexpr int kFirst = std::numeric_limits<int>::min();
  constexpr int kLast = std::numeric_limits<int>::max();
  std::vector<int> distance(fleet.size()), key(fleet.size());
  for (int robot = 0; robot < fleet.size(); ++robot) {
    const Wish& wish = wishes_[robot];
    const bool has_goal = wish.goal != kNowhere;
    distance[robot] = has_goal ? candidates_->distance(wish, wish.state) : kLast;
    const int waited = kWaitingWorth * memory_[robot].waiting;
    const int stood = kStandingWorth * std::max(0, way_->still(robot) - kStands);
    key[robot] = distance[robot] - (has_goal ? waited + stood : 0);
    if (way_->isTold(robot)) key[robot] = kFirst;
  }
  nearestFirst(distance, key);
  order_.resize(fleet.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(), [&](int one, int other) {
    return key[one] != key[other] ? key[one] < key[other] : one < other;
  });
  rank_.resize(fleet.size());
  weight_.resize(fleet.size());
  for (int rank = 0; rank < fleet.size(); ++rank) {
    const double share = 1 - static_cast<double>(rank) / fleet.size();
    rank_[order_[rank]] = rank;
    weight_[order_[rank]] = 1 + static_cast<int>(1000 * share * share);
  }
  searched_.assign(fleet.size(), 0);
  visits_.assign(fleet.size(), 0);
  settled_.assign(fleet.size(), 0);
  pass_ = search_ = 0;
}

/// Of the robots that go to the same cell the nearest inherits the first place, and so on. A robot
/// that has waited longer behind it would else push it past where both go. Those who make way are
/// told something else.
void Epibt::nearestFirst(const std::vector<int>& distance, std::vector<int>& key) const {
  std::vector<int> by_distance;
  for (int robot = 0; robot < static_cast<int>(key.size()); ++robot) {
    if (!way_->isTold(robot)) by_distance.push_back(robot);
  }
  std::vector<int> by_key = by_distance;
  const auto sort = [this](std::vector<int>& robots, const std::vector<int>& value) {
    std::sort(robots.begin(), robots.end(), [&](int one, int other) {
      return std::tie(wishes_[one].goal, value[one], one) <
             std::tie(wishes_[other].goal, value[other], other);
    });
  };
  sort(by_distance, distance);
  sort(by_key, key);
  const std::vector<int> keys = key;
  for (std::size_t i = 0; i < by_key.size(); ++i) key[by_distance[i]] = keys[by_key[i]];
}

void Epibt::visit(int robot) {
  if (searched_[robot] != search_) visits_[robot] = 0;
  searched_[robot] = search_;
  ++visits_[robot];
}

/// Finds `robot`, which has no path, the best operation for which others, one after the other, can
/// be moved aside. `gain` is what the paths that have changed so far are cheaper together.
bool Epibt::insert(int robot, std::int64_t gain, Search& search) {
  visit(robot);
  settled_[robot] = pass_;
  bool is_found = false;
  for (const Path& path : candidates_->of(robot, wishes_[robot])) {
    const int other = reserved_->conflict(robot, path);
    if (other == Reservations::kNobody) {
      is_found = search.takes_all || gain >= weigh(robot, path);
      if (is_found) reserved_->place(robot, path);
      break;  // those that follow are no better
    }
    if (other == Reservations::kSeveral || !mayMove(other, search)) continue;
    if (--search.pushes < 0) break;
    const Path others = reserved_->path(other);
    reserved_->remove(other);
    reserved_->place(robot, path);
    is_found = insert(other, gain - weigh(robot, path) + weigh(other, others), search);
    if (is_found) break;
    reserved_->remove(robot);
    reserved_->place(other, others);
  }
  if (!is_found) settled_[robot] = 0;
  return is_found;
}

/// Not who is being moved or has been already, nor who comes first.
bool Epibt::mayMove(int robot, const Search& search) const {
  if (settled_[robot] == pass_ || wishes_[robot].stopped) return false;
  if (searched_[robot] == search_ && visits_[robot] >= options_.revisits) return false;
  return search.rank < 0 || rank_[robot] > search.rank;
}

bool Epibt::replan(int robot, Search search) {
  const Path kept = reserved_->path(robot);
  reserved_->remove(robot);
  ++search_;
  if (insert(robot, weigh(robot, kept), search)) return true;
  reserved_->place(robot, kept);
  return false;
}

/// A large-neighbourhood search: moves robots aside where all together gain by it.
void Epibt::improve(const Budget& budget, double deadline) {
  if (order_.empty()) return;
  constexpr int kBetweenLooks = 8;
  const bool is_timed = budget.seconds > 0;
  if (!is_timed && budget.attempts < 0) return;
  for (int attempt = 0; attempt != budget.attempts; ++attempt) {
    if (is_timed && attempt % kBetweenLooks == 0 && threadSeconds() >= deadline) return;
    if (attempt % order_.size() == 0) {
      ++pass_;
      std::shuffle(order_.begin(), order_.end(), random_);
    }
    const int robot = order_[attempt % order_.size()];
    if (settled_[robot] != pass_) replan(robot, {false, options_.exchanges, -1});
  }
}

void Epibt::answer(const Fleet& fleet, Plan& plan) {
  plan.horizon = options_.horizon;
  plan.actions.resize(fleet.size() * plan.horizon);
  for (int robot = 0; robot < fleet.size(); ++robot) {
    const Path& path = reserved_->path(robot);
    std::copy_n(path.actions.begin(), plan.horizon, plan.actions.begin() + robot * plan.horizon);
    memory_[robot].planned = wishes_[robot].state;
    memory_[robot].deck = wishes_[robot].deck;
  }
  if (!rules_.following) plan.actions = spacing_->space(fleet, *floor_, *reserved_);
}

}  // namespace

std::unique_ptr<Planner> makeEpibt(const EpibtOptions& options) {
  return std::make_unique<Epibt>(options);
}

}  // namespace fleet
