// SPDX-License-Identifier: Apache-2.0
#include "warehouse_fleet/epibt.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include "core/floor/closures.h"
#include "core/floor/distance_tables.h"
#include "core/floor/guidance.h"
#include "core/parallel/threads.h"
#include "core/planner/dead_ends.h"
#include "core/planner/inheritance.h"
#include "core/planner/measuring.h"
#include "core/planner/spacing.h"
#include "core/planner/yielding.h"
#include "core/search/candidates.h"
#include "core/search/chain_search.h"
#include "core/search/making_way.h"
#include "core/search/priorities.h"
#include "core/search/push_search.h"
#include "core/search/reservations.h"
#include "core/search/window_search.h"

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

class Epibt : public Planner {
 public:
  explicit Epibt(const EpibtOptions& options) : options_(options), threads_(options.threads) {
    inRange("depth", options_.depth, 0, kMaxDepth);
    if (options_.horizon != 0) {
      inRange("horizon", options_.horizon, std::max(1, options_.depth), kMaxHorizon);
    }
    inRange("turn_ticks", options_.turn_ticks, 1, kMaxTurnTicks);
    if (options_.window > 0) inRange("window", options_.window, kMaxHorizon, kMostWindow);
  }

  void start(const Floor& floor, const Rules& rules, std::uint64_t seed) override;
  void plan(const Fleet& fleet, const Budget& budget, Plan& plan) override;
  void prepare(double seconds) override;
  void save(const std::string& path) const override;
  void load(const std::string& path) override;

 private:
  void beginSearch(const Fleet& fleet, const Budget& budget);
  void chooseWindow(const Fleet& fleet, const Budget& budget);
  void updateFleet(const Fleet& fleet);
  bool hasWaited(int robot, const Fleet& fleet) const;
  double against() const;
  void wish(const Fleet& fleet, double seconds);
  void replan(bool is_crowded);
  std::function<bool()> limit(const Budget& budget) const;
  void search(bool is_crowded, const std::function<bool()>& goes_on);
  bool isContent(int robot) const;
  void improve(const std::function<bool()>& goes_on);
  void answer(const Fleet& fleet, Plan& plan);

  EpibtOptions options_;
  const Threads threads_;
  std::unique_ptr<Guidance> guidance_;
  std::unique_ptr<Closures> closures_;
  std::unique_ptr<DistanceTables> tables_;
  std::unique_ptr<Measuring> measuring_;
  std::unique_ptr<Candidates> candidates_;
  std::unique_ptr<Reservations> reserved_;
  std::unique_ptr<Inheritance> inheritance_;
  std::unique_ptr<Spacing> spacing_;
  std::unique_ptr<MakingWay> way_;
  std::unique_ptr<Yielding> yielding_;
  std::unique_ptr<DeadEnds> dead_ends_;
  Rules rules_;
  const Floor* floor_ = nullptr;
  std::mt19937_64 random_;
  double begin_ = 0;  ///< begin of this step, in computing time [s]
  int now_ = 0;
  std::vector<Cell> goals_;   ///< by robot: in the last step
  std::vector<int> waiting_;  ///< by robot: ticks since it got its goal, or reached it
  std::vector<Wish> wishes_;
  Priorities priorities_;
  std::unique_ptr<PushSearch> search_;
  std::unique_ptr<ChainSearch> chains_;
  std::unique_ptr<WindowSearch> windows_;
  bool is_in_windows_ = false;  ///< whether the last plan was made in windows
};

void Epibt::start(const Floor& floor, const Rules& rules, std::uint64_t seed) {
  floor_ = &floor;
  random_.seed(seed);
  guidance_ = std::make_unique<Guidance>(
      floor, GuidanceOptions{options_.crowd, options_.resting, options_.at_lanes, options_.streets,
                             options_.memory});
  closures_ = std::make_unique<Closures>(floor, guidance_->costs());
  tables_ = std::make_unique<DistanceTables>(
      floor, closures_->edges(),
      TableOptions{options_.turn_ticks, options_.table_bytes, options_.whole_up_to}, threads_);
  measuring_ = std::make_unique<Measuring>(
      floor, MeasuringOptions{options_.table_work, options_.renewal_work, options_.renewal_age},
      *tables_);
  way_ = std::make_unique<MakingWay>(floor, options_.patience);
  yielding_ = std::make_unique<Yielding>(floor, options_.pursuing);
  dead_ends_ = std::make_unique<DeadEnds>(floor);
  rules_ = rules;
}

/// Chooses the depth of operations by the first step's budget, if no option has it.
void Epibt::beginSearch(const Fleet& fleet, const Budget& budget) {
  constexpr double kDeep = 0.25e-3;  // [s] a robot; a longer operation costs 20 us
  if (options_.depth == 0) options_.depth = budget.seconds > kDeep * fleet.size() ? 5 : 4;
  if (options_.horizon == 0) options_.horizon = options_.depth;
  options_.depth = std::min(options_.depth, options_.horizon);
  const int horizon = options_.horizon;
  candidates_ = std::make_unique<Candidates>(*floor_, closures_->edges(), options_.depth, horizon);
  reserved_ = std::make_unique<Reservations>(*floor_, rules_, horizon);
  inheritance_ = std::make_unique<Inheritance>(wishes_, *candidates_, *reserved_, threads_);
  spacing_ = std::make_unique<Spacing>(horizon);
  search_ = std::make_unique<PushSearch>(wishes_, priorities_, *candidates_, *reserved_,
                                         options_.revisits);
  chains_ = std::make_unique<ChainSearch>(*floor_, rules_, horizon, wishes_, priorities_,
                                          *candidates_, *reserved_, *search_);
  chooseWindow(fleet, budget);
}

/// Plans few robots in windows if the budget allows it, unless an option forbids it.
void Epibt::chooseWindow(const Fleet& fleet, const Budget& budget) {
  constexpr double kMuch = 0.04e-3;  // [s] a robot
  constexpr int kFew = 3;            // passable cells for each robot, at least
  constexpr int kTicks = 15;
  if (options_.window == 0) {
    int passable = 0;
    for (Cell cell = 0; cell < floor_->size(); ++cell) passable += floor_->isPassable(cell);
    const bool are_few = kFew * fleet.size() <= passable;
    options_.window = are_few && budget.seconds > kMuch * fleet.size() ? kTicks : -1;
  }
  if (options_.window < 0) return;
  windows_ = std::make_unique<WindowSearch>(*floor_, rules_, options_.window, wishes_, priorities_,
                                            *candidates_);
}

void Epibt::plan(const Fleet& fleet, const Budget& budget, Plan& plan) {
  begin_ = threadSeconds();
  check(*floor_, fleet);
  if (search_ == nullptr) beginSearch(fleet, budget);
  updateFleet(fleet);
  closures_->update(fleet);
  wish(fleet, budget.seconds);
  const bool is_crowded = yielding_->choose(waiting_, *candidates_, wishes_);
  if (is_crowded) dead_ends_->empty(*tables_, *candidates_, wishes_);
  way_->direct(fleet, !is_crowded, *candidates_, wishes_);
  inheritance_->begin(fleet);
  priorities_.assign(wishes_, waiting_, *candidates_, *way_);
  search(is_crowded, limit(budget));
  answer(fleet, plan);
  ++now_;
}

/// Learns from the outcome of the last plan.
void Epibt::updateFleet(const Fleet& fleet) {
  if (fleet.size() < static_cast<int>(goals_.size())) {
    goals_.clear();
    waiting_.clear();
  }
  goals_.resize(fleet.size(), kNowhere);
  waiting_.resize(fleet.size());
  for (int robot = 0; robot < fleet.size(); ++robot) {
    ++waiting_[robot];
    const Cell goal = std::exchange(goals_[robot], fleet.goal[robot]);
    if (goal != fleet.goal[robot] || fleet.cell[robot] == goal) waiting_[robot] = 0;
    if (static_cast<int>(wishes_.size()) <= robot) continue;
    const GridPose& was = wishes_[robot].state;
    if (was.cell != fleet.cell[robot]) {
      guidance_->drove(was.cell, was.heading);
    } else if (hasWaited(robot, fleet)) {
      guidance_->waited(was.cell);
    }
  }
  guidance_->tick();
  for (int robot = 0; robot < fleet.size(); ++robot) {
    if (fleet.cell[robot] == fleet.goal[robot]) guidance_->rests(fleet.cell[robot]);
  }
  constexpr int kRefresh = 10;
  if (now_ % kRefresh != 0) return;
  guidance_->refresh(against());
  tables_->reprice();
}

/// Returns whether a robot that has not left its cell waited on its way. In a jam many turn to and
/// fro: a turn that takes longer than half a circle is no progress.
bool Epibt::hasWaited(int robot, const Fleet& fleet) const {
  constexpr int kHalfCircle = 2;  // [ticks]
  const Wish& wish = wishes_[robot];
  if (wish.goal == kNowhere) return false;
  return wish.state.heading == fleet.heading[robot] || way_->still(robot) >= kHalfCircle;
}

double Epibt::against() const {
  constexpr double kUnforeseen = 10, kForeseen = 3;
  if (options_.against >= 0) return options_.against;
  return is_in_windows_ ? kForeseen : kUnforeseen;
}

void Epibt::wish(const Fleet& fleet, double seconds) {
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
  measuring_->measure(now_, closures_->version(), seconds, *way_, wishes_);
  candidates_->begin(fleet.size());
}

void Epibt::prepare(double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  tables_->prepare([&] { return std::chrono::steady_clock::now() < end; });
}

void Epibt::save(const std::string& path) const { tables_->save(path); }

void Epibt::load(const std::string& path) { tables_->load(path); }

/// Returns a function that decides before each attempt to improve the plan whether it may be made.
std::function<bool()> Epibt::limit(const Budget& budget) const {
  constexpr int kBetweenLooks = 8;
  return [budget, deadline = begin_ + budget.seconds, attempt = -1]() mutable {
    if (++attempt == budget.attempts) return false;
    if (budget.seconds <= 0) return budget.attempts >= 0;
    return attempt % kBetweenLooks != 0 || threadSeconds() < deadline;
  };
}

void Epibt::search(bool is_crowded, const std::function<bool()>& goes_on) {
  is_in_windows_ = windows_ != nullptr && !is_crowded && windows_->canPlan();
  if (!is_in_windows_ || !windows_->inherit()) {
    candidates_->find(wishes_, threads_);
    replan(is_crowded);
    if (is_in_windows_) windows_->adopt(*reserved_, options_.horizon);
  }
  if (!is_in_windows_) return improve(goes_on);
  windows_->improve(goes_on, random_);
  windows_->write(*reserved_, options_.horizon);
}

/// Returns whether the robot has no goal elsewhere and stands: no operation is better.
bool Epibt::isContent(int robot) const {
  if (wishes_[robot].goal != kNowhere || wishes_[robot].yields) return false;
  const auto& actions = reserved_->path(robot).actions;
  return std::all_of(actions.begin(), actions.begin() + options_.horizon,
                     [](Action action) { return action == Action::kWait; });
}

/// Searches for a better operation for each robot, by rank. On a crowded floor, robots that yield
/// keep their operations, and robots that can't get nearer by pushing try a chain.
void Epibt::replan(bool is_crowded) {
  search_->begin(static_cast<int>(wishes_.size()));
  search_->beginPass();
  for (const int robot : priorities_.order()) {
    if (search_->isSettled(robot) || wishes_[robot].yields) continue;
    if (isContent(robot)) {
      search_->settle(robot);
      continue;
    }
    search_->replan(robot, {true, options_.pushes, priorities_.rank(robot)});
    if (is_crowded && chains_->isStuck(robot)) chains_->advance(robot);
  }
}

/// Improves the plan by a large-neighbourhood search: moves robots aside where that lowers the cost
/// of all.
void Epibt::improve(const std::function<bool()>& goes_on) {
  std::vector<int> order;
  std::copy_if(priorities_.order().begin(), priorities_.order().end(), std::back_inserter(order),
               [this](int robot) { return !wishes_[robot].yields; });
  if (order.empty()) return;
  for (std::size_t attempt = 0; goes_on(); ++attempt) {
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
  }
  inheritance_->remember();
  if (!rules_.following) plan.actions = spacing_->space(fleet, *floor_, *reserved_);
}

}  // namespace

std::unique_ptr<Planner> makeEpibt(const EpibtOptions& options) {
  return std::make_unique<Epibt>(options);
}

}  // namespace fleet
