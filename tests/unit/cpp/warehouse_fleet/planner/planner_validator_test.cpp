// SPDX-License-Identifier: Apache-2.0
//
// Each violation of a plan is found, with its robots; permitted plans have none.
#include "planner_shift.h"

namespace fleet::test {
namespace {

using Kind = Violation::Kind;

/// Robots on a floor of 4 x 3 cells, its second row storage places at x = 2 and 3.
struct PlanCase {
  const Floor floor{drawn({"....", "..SS", "...."})};
  Fleet fleet;
  Plan plan;
  Rules rules;

  void robot(Cell cell, int heading, std::vector<Action> actions, bool is_loaded = false) {
    fleet.cell.push_back(cell);
    fleet.heading.push_back(static_cast<Heading>(heading));
    fleet.goal.push_back(kNowhere);
    fleet.loaded.push_back(is_loaded);
    plan.horizon = static_cast<int>(actions.size());
    plan.actions.insert(plan.actions.end(), actions.begin(), actions.end());
  }

  std::string violations(const std::vector<std::string>& names = {}) const {
    std::string text;
    for (const auto& violation : validate(floor, fleet, plan, rules)) {
      text += describe(violation, floor, names) + "\n";
    }
    return text;
  }
};

constexpr Action W = Action::kWait, F = Action::kForward, P = Action::kTurnPositive;

TEST(Validator, SeesTwoInOneCell) {
  PlanCase is;
  is.robot(0, 0, {F});
  is.robot(2, 2, {F});
  EXPECT_EQ(is.violations({"kiva3", "kiva7"}),
            "kiva3 and kiva7 would both be in (1, 0) (tick 0)\n");
}

TEST(Validator, SeesASwap) {
  PlanCase is;
  is.robot(0, 0, {W, F});
  is.robot(1, 2, {W, F});
  EXPECT_EQ(is.violations(), "robot 0 and robot 1 would exchange their cells at (1, 0) (tick 1)\n");
}

TEST(Validator, SeesARingUnlessItIsAllowed) {
  PlanCase is;
  is.robot(0, 0, {F});
  is.robot(1, 1, {F});
  is.robot(5, 2, {F});
  is.robot(4, 3, {F});
  EXPECT_EQ(is.violations(),
            "robot 0, robot 1, robot 2 and robot 3 would move around in a ring at (1, 0) (tick "
            "0)\n");
  is.rules.rings = true;
  EXPECT_EQ(is.violations(), "");
}

TEST(Validator, SeesFollowingWhereItIsForbidden) {
  PlanCase is;
  is.robot(0, 0, {F});
  is.robot(1, 0, {F});
  EXPECT_EQ(is.violations(), "");
  is.rules.following = false;
  EXPECT_EQ(is.violations(),
            "robot 0 and robot 1: the first would enter (1, 0) while the other leaves it (tick "
            "0)\n");
}

TEST(Validator, SeesWallsStoragePlacesAndClosedCells) {
  PlanCase is;
  is.robot(3, 0, {F});
  is.robot(5, 0, {F}, true);
  is.robot(9, 0, {F});
  is.fleet.closed = {10};
  EXPECT_EQ(is.violations(),
            "robot 0 would drive out of (3, 0) where there is no way (tick 0)\n"
            "robot 1 would drive out of (1, 1) where there is no way (tick 0)\n"
            "robot 2 would drive out of (1, 2) where there is no way (tick 0)\n");
  is.fleet.home = {kNowhere, 6, kNowhere};
  is.fleet.closed = {};
  EXPECT_EQ(is.violations(), "robot 0 would drive out of (3, 0) where there is no way (tick 0)\n");
}

TEST(Validator, SeesWhoEntersAZoneAndLetsThoseInsideDriveOut) {
  PlanCase is;
  is.robot(0, 0, {F});  // into it
  is.robot(9, 0, {F});  // within, and the third out of it
  is.robot(10, 0, {F});
  is.fleet.zone = {1, 9, 10};
  EXPECT_EQ(is.violations(), "robot 0 would drive out of (0, 0) where there is no way (tick 0)\n");
}

TEST(Validator, SeesLoadedRobotsTurnSideBySide) {
  PlanCase is;
  is.robot(0, 0, {P}, true);
  is.robot(1, 0, {P}, true);
  is.robot(8, 0, {P}, true);
  is.robot(9, 0, {P}, false);
  EXPECT_EQ(is.violations(),
            "robot 0 and robot 1 would turn side by side with their units at (0, 0) (tick 0)\n");
}

TEST(Validator, SeesWhatWasPromisedOtherwise) {
  PlanCase is;
  is.robot(0, 0, {W, F});
  is.robot(8, 0, {F, W});
  is.fleet.committed = {1, Fleet::kFree, Fleet::kFree, Fleet::kFree};
  is.fleet.committed_ticks = 2;
  is.fleet.stopped = {0, 1};
  EXPECT_EQ(is.violations(),
            "robot 0 would not do at (0, 0) what it is committed to (tick 0)\n"
            "robot 1 is stopped at (0, 2) and would move (tick 0)\n");
}

TEST(Validator, RefusesAPlanOfAnotherSize) {
  PlanCase is;
  is.robot(0, 0, {F});
  is.plan.actions.push_back(W);
  EXPECT_THROW(is.violations(), FloorError);
}

}  // namespace
}  // namespace fleet::test
