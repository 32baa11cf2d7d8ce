// SPDX-License-Identifier: Apache-2.0
#include "core/planner/measuring.h"

#include <algorithm>

namespace fleet {
namespace {

bool isOnTheWay(const Wish& wish) { return wish.goal != kNowhere && !wish.stopped; }

}  // namespace

void Measuring::measure(int now, int version, double seconds, const MakingWay& way,
                        std::vector<Wish>& wishes) {
  tables_.begin(now, version, work(options_.table_work, wishes.size()));
  need(wishes);
  tables_.make();
  constexpr int kImpatient = 5;  // ticks in a cell after which a robot gets a renewed table
  for (int robot = 0; robot < static_cast<int>(wishes.size()); ++robot) {
    Wish& wish = wishes[robot];
    const bool waits = way.still(robot) >= kImpatient && !floor_.isLane(wish.state.cell);
    if (isOnTheWay(wish)) find(waits, wish);
  }
  renew(seconds, wishes.size());
}

/// Robots drive into a jam of which their tables do not know yet, and it grows. So a fifth of a
/// step's time is for renewals, even if the options' work is done.
void Measuring::renew(double seconds, std::size_t robots) {
  constexpr double kShare = 0.2, kStatesASecond = 80e6;
  constexpr int kLeastShare = 4;  // share of the work that is left whatever new tables took
  const std::int64_t most = work(options_.renewal_work, robots);
  constexpr double kMost = 1e9;  // states
  const auto in_time =
      static_cast<std::int64_t>(std::min(kMost, kShare * kStatesASecond * seconds));
  tables_.renew(options_.renewal_age, most, std::max(most / kLeastShare, in_time));
}

/// Serves robots near their goals first: from far away a region's table suffices.
void Measuring::need(const std::vector<Wish>& wishes) {
  for (const bool is_near : {true, false}) {
    for (const Wish& wish : wishes) {
      if (isOnTheWay(wish) && tables_.areNear(wish.state.cell, wish.goal) == is_near) {
        tables_.need(wish.deck, wish.goal);
      }
    }
  }
}

void Measuring::find(bool waits, Wish& wish) {
  wish.table = tables_.find(wish.deck, wish.state.cell, wish.goal, waits);
  if (wish.table == nullptr || wish.table->reaches(wish.state.cell)) return;
  // A way may have opened by now.
  tables_.find(wish.deck, wish.state.cell, wish.goal, true);
  wish.goal = kNowhere;
}

/// Returns the limit of states in the tables that one step makes.
std::int64_t Measuring::work(std::int64_t a_robot, std::size_t robots) const {
  constexpr std::int64_t kLeast = 60000;
  // Less suffices on large floors, where robots share most of a table. With 400 no more robots
  // arrive, and the slowest steps take a fifth longer.
  constexpr std::int64_t kMostAtOnce = 3000000, kMostARobot = 140;
  if (tables_.hasRegions()) a_robot = std::min(a_robot, kMostARobot);
  const auto work = std::max(kLeast, a_robot * static_cast<std::int64_t>(robots));
  return tables_.hasRegions() ? std::min(kMostAtOnce, work) : work;
}

}  // namespace fleet
