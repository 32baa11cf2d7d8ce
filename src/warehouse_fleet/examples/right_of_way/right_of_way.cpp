// SPDX-License-Identifier: Apache-2.0
//
// An example of a planner: each robot in turn drives along x, then along y, and gives way to all
// robots before it in the list. It is safe, but robots that meet head on stand for ever: compare it
// with the built-in planner. A YAML file names it by
//
//   planner: /path/to/libright_of_way.so:RightOfWay
#include <unordered_set>

#include "warehouse_fleet/planner.h"
#include "warehouse_layout/register_plugin.h"

namespace {

class RightOfWay : public fleet::Planner {
 public:
  void start(const fleet::Floor& floor, const fleet::Rules& /*rules*/,
             std::uint64_t /*seed*/) override {
    floor_ = &floor;
  }

  void plan(const fleet::Fleet& fleet, const fleet::Budget& /*budget*/,
            fleet::Plan& plan) override {
    // No robot enters a cell that another robot is in or goes to: none swap, follow or meet.
    std::unordered_set<fleet::Cell> taken(fleet.cell.begin(), fleet.cell.end());
    taken.insert(fleet.closed.begin(), fleet.closed.end());
    plan.horizon = 1;
    plan.actions.assign(fleet.size(), fleet::Action::kWait);
    for (int robot = 0; robot < fleet.size(); ++robot) {
      const fleet::Action action = preferredAction(fleet, robot);
      if (action == fleet::Action::kForward) {
        const fleet::Cell next =
            floor_->next(fleet.deck(robot), fleet.cell[robot], fleet.heading[robot]);
        if (next == fleet::kNowhere || !taken.insert(next).second) continue;
      }
      plan.actions[robot] = action;
    }
  }

 private:
  fleet::Action preferredAction(const fleet::Fleet& fleet, int robot) const {
    const fleet::Cell goal = fleet.goal[robot], cell = fleet.cell[robot];
    if (goal == fleet::kNowhere || goal == cell || fleet.isStopped(robot)) {
      return fleet::Action::kWait;
    }
    const int along_x = floor_->x(goal) - floor_->x(cell);
    const int along_y = floor_->y(goal) - floor_->y(cell);
    const int heading = along_x > 0 ? 0 : along_x < 0 ? 2 : along_y > 0 ? 1 : 3;
    const int quarters = fleet::turned(heading, -fleet.heading[robot]);
    if (quarters == 0) return fleet::Action::kForward;
    return quarters == 3 ? fleet::Action::kTurnNegative : fleet::Action::kTurnPositive;
  }

  const fleet::Floor* floor_ = nullptr;
};

}  // namespace

// Registers the class, so that a program can load it by name.
WAREHOUSE_ADD_PLUGIN(RightOfWay, fleet::Planner)
