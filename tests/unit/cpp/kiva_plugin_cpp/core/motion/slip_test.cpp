// SPDX-License-Identifier: Apache-2.0
//
// Robots on ice: sliding distances, staying in place after a stop, and commands that still end at
// their goals.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;

constexpr double kGravity = 9.81;       // [m/s²]
constexpr double kWheelLoad = 0.8;      // share of the weight that is on the driven wheels
constexpr double kStaysWithin = 0.002;  // [m]

/// A robot at the origin, and ice from one x to another.
class Ice : public Warehouse {
 public:
  Ice(double friction, double from, double to, const std::string& drive = "traction")
      : Warehouse(planOf(friction, from, to)) {
    spawnText(kivaText({{"drive", drive}}), "kiva1", 0, 0);
    forget();
  }
  void stop(bool stops) {
    Command command;
    command.kind = stops ? Command::Kind::kStop : Command::Kind::kGoOn;
    command.kiva_id = 1;
    world.post(command);
  }

 private:
  static Floorplan planOf(double friction, double from, double to) {
    Floorplan plan{60};
    plan.more = "<plugin name='ice' filename='libkiva_floor_patch.so'><centre>" +
                number((from + to) / 2) + " 0</centre><size>" + number(to - from) +
                " 4</size><friction>" + number(friction) + "</friction></plugin>";
    return plan;
  }
};

class StoppedOnIce : public ::testing::TestWithParam<std::tuple<const char*, double>> {};

/// v² = v0² - 2 a s before the ice, then mu g of what the driven wheels carry.
TEST_P(StoppedOnIce, StaysWhereItSlidTo) {
  const auto [drive, friction] = GetParam();
  Ice w(friction, 5, 25, drive);
  w.movx(1, 20);
  w.runUntil([&] { return w.x(1) >= 4.7; }, 10);
  const double from = w.x(1), speed = w.speed(1);
  w.stop(true);
  double farthest = from, backwards = 0;
  w.run(12, [&] {
    farthest = std::max(farthest, w.x(1));
    backwards = std::max(backwards, -w.world.fleet().vx[0]);
  });
  const double before = 5 - from;
  const double hard = w.robot(1).drive.emergency_deceleration;
  const double at_edge = speed * speed - 2 * hard * before;
  const double slide = before + at_edge / (2 * friction * kGravity * kWheelLoad);
  if (std::string(drive) == "traction") EXPECT_NEAR(farthest - from, slide, 0.03 * slide);
  EXPECT_LT(farthest - w.x(1), kStaysWithin);
  EXPECT_LT(backwards, 0.02);
  w.stop(false);
  w.runUntilIdle(1, 120);
  w.expectAt(1, 20, 0);
  EXPECT_EQ(w.count(Kind::kDone), 1);
}

INSTANTIATE_TEST_SUITE_P(All, StoppedOnIce,
                         ::testing::Combine(::testing::Values("traction", "jointed"),
                                            ::testing::Values(0.05, 0.1, 0.2)));

class GoalOnIce : public ::testing::TestWithParam<std::tuple<const char*, double, double>> {};

/// It slides past its goal, stops, and backs to it.
TEST_P(GoalOnIce, IsReached) {
  const auto [drive, friction, from] = GetParam();
  Ice w(friction, from, 12, drive);
  w.movx(1, 5);
  double farthest = 0;
  w.runUntilIdle(1, 60, [&] { farthest = std::max(farthest, w.x(1)); });
  w.expectAt(1, 5, 0);
  EXPECT_EQ(w.count(Kind::kDone), 1);
  if (friction <= 0.1) EXPECT_GT(farthest, 5.2);  // else nothing was tried
}

INSTANTIATE_TEST_SUITE_P(All, GoalOnIce,
                         ::testing::Combine(::testing::Values("traction", "jointed"),
                                            ::testing::Values(0.05, 0.1, 0.2),
                                            ::testing::Values(3.5, 4.0)));

/// A unit has come behind the robot, which carries one, while it slid.
TEST(GoalOnIce, SaysHowFarOffItIsWhereTheWayBackIsBlocked) {
  Ice w(0.05, 4, 12);
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  w.carry(1, 1);
  w.runUntilIdle(1);
  w.forget();
  w.movx(1, 5);
  w.runUntil([&] { return w.x(1) > 5.9; }, 20);
  w.spawn("storage_unit", "storage_unit2", 5, 0);
  w.runUntilIdle(1, 60);
  EXPECT_PRED2(contains, w.last(Kind::kBlocked).text, "m past its goal, and has no room to return");
  EXPECT_EQ(w.count(Kind::kCollision), 0);
}

}  // namespace
}  // namespace kiva::test
