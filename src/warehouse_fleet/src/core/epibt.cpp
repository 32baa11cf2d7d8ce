// SPDX-License-Identifier: Apache-2.0
#include "warehouse_fleet/epibt.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <memory>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>

#include "candidates.h"
#include "chain_search.h"
#include "closures.h"
#include "dead_ends.h"
#include "distance_tables.h"
#include "guidance.h"
#include "making_way.h"
#include "priorities.h"
#include "push_search.h"
#include "reservations.h"
#include "spacing.h"
#include "threads.h"
#include "yielding.h"

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
  State planned;  ///< where its path begins
  Deck deck = Deck::kUnder;
};

class Epibt : public Planner {
 public:
  explicit Epibt(const EpibtOptions& options) : options_(options), threads_(options.threads) {
    inRange("depth", options_.depth, 0, kMaxDepth);
    if (options_.horizon != 0) {
      inRange("horizon", options_.horizon, std::max(1, options_.depth), kMaxHorizon);
    }
    inRange("turn_ticks", options_.turn_ticks, 1, kMaxTurnTicks);
  }

  void start(const Floor& floor, const Rules& rules, std::uint64_t seed) override;
  void plan(const Fleet& fleet, const Budget& budget, Plan& plan) override;
  void prepare(double seconds) override;
  void save(const std::string& path) const override;
  void load(const std::string& path) override;

 private:
  void beginSearch(const Fleet& fleet, const Budget& budget);
  void updateFleet(const Fleet& fleet);
  void wish(const Fleet& fleet);
  void measure();
  std::int64_t tableWork(std::int64_t a_robot) const;
  void inherit(const Fleet& fleet);
  void resume(const std::vector<Path>& rests);
  void replan(bool is_crowded);
  void improve(const Budget& budget, double deadline);
  void answer(const Fleet& fleet, Plan& plan);

  EpibtOptions options_;
  const Threads threads_;
  std::unique_ptr<Guidance> guidance_;
  std::unique_ptr<Closures> closures_;
  std::unique_ptr<DistanceTables> tables_;
  std::unique_ptr<Candidates> candidates_;
  std::unique_ptr<Reservations> reserved_;
  std::unique_ptr<Spacing> spacing_;
  std::unique_ptr<MakingWay> way_;
  std::unique_ptr<Yielding> yielding_;
  std::unique_ptr<DeadEnds> dead_ends_;
  Rules rules_;
  const Floor* floor_ = nullptr;
  std::mt19937_64 random_;
  int now_ = 0;
  std::vector<Memory> memory_;
  std::vector<int> waiting_;  ///< by robot: ticks since it was given its goal, or reached it
  std::vector<Wish> wishes_;
  Priorities priorities_;
  std::unique_ptr<PushSearch> search_;
  std::unique_ptr<ChainSearch> chains_;
};

void Epibt::start(const Floor& floor, const Rules& rules, std::uint64_t seed) {
  floor_ = &floor;
  random_.seed(seed);
  guidance_ = std::make_unique<Guidance>(
      floor, GuidanceOptions{options_.against, options_.crowd, options_.resting, options_.at_lanes,
                             options_.memory});
  closures_ = std::make_unique<Closures>(floor, guidance_->costs());
  tables_ = std::make_unique<DistanceTables>(
      floor, closures_->edges(),
      TableOptions{options_.turn_ticks, options_.table_bytes, options_.whole_up_to}, threads_);
  way_ = std::make_unique<MakingWay>(floor, options_.patience);
  yielding_ = std::make_unique<Yielding>(floor, options_.pursuing);
  dead_ends_ = std::make_unique<DeadEnds>(floor);
  rules_ = rules;
}

/// Chooses how far the first step's time lets operations reach, if no option says so.
void Epibt::beginSearch(const Fleet& fleet, const Budget& budget) {
  constexpr double kDeep = 0.25e-3;  // [s] a robot: a longer operation costs 20 us
  if (options_.depth == 0) options_.depth = budget.seconds > kDeep * fleet.size() ? 5 : 4;
  if (options_.horizon == 0) options_.horizon = options_.depth;
  options_.depth = std::min(options_.depth, options_.horizon);
  const int horizon = options_.horizon;
  candidates_ = std::make_unique<Candidates>(*floor_, closures_->edges(), options_.depth, horizon);
  reserved_ = std::make_unique<Reservations>(*floor_, rules_, horizon);
  spacing_ = std::make_unique<Spacing>(horizon);
  search_ = std::make_unique<PushSearch>(wishes_, priorities_, *candidates_, *reserved_,
                                         options_.revisits);
  chains_ = std::make_unique<ChainSearch>(*floor_, rules_, horizon, wishes_, priorities_,
                                          *candidates_, *reserved_, *search_);
}

void Epibt::plan(const Fleet& fleet, const Budget& budget, Plan& plan) {
  const double deadline = threadSeconds() + budget.seconds;
  check(*floor_, fleet);
  if (search_ == nullptr) beginSearch(fleet, budget);
  updateFleet(fleet);
  closures_->update(fleet);
  wish(fleet);
  const bool is_crowded = yielding_->choose(waiting_, *candidates_, wishes_);
  if (is_crowded) dead_ends_->empty(*tables_, *candidates_, wishes_);
  way_->direct(fleet, !is_crowded, *candidates_, wishes_);
  inherit(fleet);
  priorities_.assign(wishes_, waiting_, *candidates_, *way_);
  candidates_->find(wishes_, threads_);
  replan(is_crowded);
  improve(budget, deadline);
  answer(fleet, plan);
  ++now_;
}

/// Learns from what has become of the last plan.
void Epibt::updateFleet(const Fleet& fleet) {
  if (fleet.size() < static_cast<int>(memory_.size())) {
    memory_.clear();
    waiting_.clear();
  }
  memory_.resize(fleet.size());
  waiting_.resize(fleet.size());
  for (int robot = 0; robot < fleet.size(); ++robot) {
    Memory& memory = memory_[robot];
    ++waiting_[robot];
    if (memory.goal != fleet.goal[robot] || fleet.cell[robot] == memory.goal) waiting_[robot] = 0;
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

void Epibt::wish(const Fleet& fleet) {
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
  }
  measure();
  candidates_->begin(fleet.size());
}

/// Finds each robot the table to its goal.
void Epibt::measure() {
  tables_->begin(now_, closures_->version(), tableWork(options_.table_work));
  const auto needs = [](const Wish& wish) { return wish.goal != kNowhere && !wish.stopped; };
  for (const bool is_near : {true, false}) {
    for (const Wish& wish : wishes_) {
      if (needs(wish) && tables_->areNear(wish.state.cell, wish.goal) == is_near) {
        tables_->need(wish.deck, wish.goal);
      }
    }
  }
  tables_->make();
  constexpr int kImpatient = 5;  // ticks in a cell after which other ways are looked for
  for (int robot = 0; robot < static_cast<int>(wishes_.size()); ++robot) {
    Wish& wish = wishes_[robot];
    if (!needs(wish)) continue;
    const bool waits = way_->still(robot) >= kImpatient && !floor_->isLane(wish.state.cell);
    wish.table = tables_->find(wish.deck, wish.state.cell, wish.goal, waits);
    if (wish.table == nullptr || wish.table->reaches(wish.state.cell)) continue;
    // Perhaps there is a way by now.
    tables_->find(wish.deck, wish.state.cell, wish.goal, true);
    wish.goal = kNowhere;
  }
  tables_->renew(options_.renewal_age, tableWork(options_.renewal_work));
}

/// Returns how many states tables that are made in one step may have.
std::int64_t Epibt::tableWork(std::int64_t a_robot) const {
  constexpr std::int64_t kLeast = 60000;
  // On large floors most of a table is shared, so that less does.
  constexpr std::int64_t kMostAtOnce = 3000000, kMostARobot = 400;
  if (tables_->hasRegions()) a_robot = std::min(a_robot, kMostARobot);
  const auto work = std::max(kLeast, a_robot * static_cast<std::int64_t>(wishes_.size()));
  return tables_->hasRegions() ? std::min(kMostAtOnce, work) : work;
}

void Epibt::prepare(double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  tables_->prepare([&] { return std::chrono::steady_clock::now() < end; });
}

void Epibt::save(const std::string& path) const {
  std::ofstream file(path, std::ios::binary);
  if (file) tables_->save(file);
  file.close();
  if (!file) throw std::runtime_error(path + ": the tables could not be written");
}

void Epibt::load(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": no such file, or it can't be read");
  try {
    tables_->load(file);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
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

/// Looks for a better operation for each robot, by rank. On a crowded floor robots that yield keep
/// what they have, and those that get no nearer by pushing do so by a chain.
void Epibt::replan(bool is_crowded) {
  search_->begin(static_cast<int>(wishes_.size()));
  search_->beginPass();
  for (const int robot : priorities_.order()) {
    if (search_->isSettled(robot) || wishes_[robot].yields) continue;
    search_->replan(robot, {true, options_.pushes, priorities_.rank(robot)});
    if (is_crowded && chains_->isStuck(robot)) chains_->advance(robot);
  }
}

/// A large-neighbourhood search: moves robots aside where all together gain by it.
void Epibt::improve(const Budget& budget, double deadline) {
  std::vector<int> order;
  std::copy_if(priorities_.order().begin(), priorities_.order().end(), std::back_inserter(order),
               [this](int robot) { return !wishes_[robot].yields; });
  if (order.empty()) return;
  constexpr int kBetweenLooks = 8;
  const bool is_timed = budget.seconds > 0;
  if (!is_timed && budget.attempts < 0) return;
  for (int attempt = 0; attempt != budget.attempts; ++attempt) {
    if (is_timed && attempt % kBetweenLooks == 0 && threadSeconds() >= deadline) return;
    if (attempt % order.size() == 0) {
      search_->beginPass();
      std::shuffle(order.begin(), order.end(), random_);
    }
    const int robot = order[attempt % order.size()];
    if (!search_->isSettled(robot)) search_->replan(robot, {false, options_.exchanges, -1});
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
