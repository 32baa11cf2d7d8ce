// SPDX-License-Identifier: Apache-2.0
//
// Speed limits of paths, from point to point, as physics: the chassis' speed over its place.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;
constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr double kTop = 1.5;     // [m/s]
constexpr double kExact = 1e-6;  // [m/s]

class SpeedLimitTest : public testing::Test {
 protected:
  void SetUp() override { w.spawn("kiva", "kiva1", 0, 0); }

  /// A path along x from 0; speeds[k] is the limit of the way to point k + 1.
  static FollowPath path(const std::vector<double>& speeds, std::uint32_t first = 0) {
    FollowPath out;
    out.kiva_id = 1;
    out.path_id = 7;
    out.first = first;
    for (std::size_t k = 0; k <= speeds.size(); ++k) {
      out.x.push_back(static_cast<double>(first + k));
      out.y.push_back(0);
      out.max_speed.push_back(k == 0 ? kAny : speeds[k - 1]);
    }
    out.released = first + static_cast<std::uint32_t>(out.x.size());
    return out;
  }

  /// Drives to the end of the path; `look` is called after each step.
  template <typename Look>
  void drive(Look look) {
    w.runUntil([&] { return w.status(1) == Status::kIdle; }, 120, look);
    EXPECT_EQ(w.count(Kind::kRefused), 0);
    EXPECT_EQ(w.count(Kind::kDone), 1);
  }

  std::string refused(const FollowPath& wrong) {
    w.world.post(wrong);
    return w.refusal();
  }

  Warehouse w;
};

TEST_F(SpeedLimitTest, TheCentreIsNeverFasterThanTheLimitOfItsWay) {
  const std::vector<double> speeds{kAny, kAny, kAny, 0.2, 0.2, kAny, kAny, kAny, 0.7, 0.3, kAny};
  w.world.post(path(speeds));
  std::vector<double> most(speeds.size(), 0);
  double least = kTop;
  drive([&] {
    const double x = w.x(1);
    const auto way = static_cast<std::size_t>(std::clamp(std::floor(x), 0.0, 10.0));
    most[way] = std::max(most[way], w.speed(1));
    if (x > 3.01 && x < 4.99) least = std::min(least, w.speed(1));
  });
  for (std::size_t k = 0; k < speeds.size(); ++k) EXPECT_LE(most[k], speeds[k] + kExact) << k;
  EXPECT_GT(most[2], 1.2) << "it brakes no earlier than it has to";
  EXPECT_NEAR(least, 0.2, kExact) << "no dip between two ways of the same limit";
  EXPECT_GT(most[6], 1.4) << "it accelerates past the end of the limit";
  EXPECT_NEAR(most[9], 0.3, kExact);
  w.expectAt(1, 11, 0);
}

TEST_F(SpeedLimitTest, TwoMetresTakeTheirTime) {
  w.world.post(path({0.2, 0.2}));
  const double begin = w.world.time();
  drive([] {});
  const double slow = w.world.time() - begin;
  EXPECT_NEAR(slow, 2 / 0.2 + 0.2, 0.15);  // and a fifth of a second for both ends at 1 m/s²
}

TEST_F(SpeedLimitTest, ItCruisesWithinALimit) {
  w.world.post(path(std::vector<double>(8, 0.5)));
  w.run(2);
  int cruised = 0;
  for (int k = 0; k < 1000; ++k) {
    w.step();
    cruised += insideOf(w.world).fleet.cruising[0] != 0;
  }
  EXPECT_GT(cruised, 990) << "a limit costs arrays, not single steps";
}

TEST_F(SpeedLimitTest, ALimitThatComesWhileItDrivesBrakesItAtOnceAndItsEndLetsItGo) {
  w.world.post(path(std::vector<double>(14, kAny)));
  w.runUntil([&] { return w.x(1) > 3.5; }, 30);
  EXPECT_NEAR(w.speed(1), kTop, kExact);
  w.world.post(path(std::vector<double>(11, 0.3), 3));
  double before = w.speed(1);
  w.step();
  w.step();
  EXPECT_LT(w.speed(1), before);
  w.runUntil([&] { return w.speed(1) < 0.3 + kExact; }, 3);
  EXPECT_LT(w.x(1), 4.7);
  w.runUntil([&] { return w.x(1) > 6.5; }, 20, [&] { EXPECT_LE(w.speed(1), 0.3 + kExact); });
  w.world.post(path(std::vector<double>(8, kAny), 6));
  double top = 0;
  drive([&] { top = std::max(top, w.speed(1)); });
  EXPECT_NEAR(top, kTop, kExact);
}

TEST_F(SpeedLimitTest, ReleasesBetweenWaysOfTheSameLimitMakeNoDip) {
  FollowPath begin = path(std::vector<double>(3, 0.6));
  w.world.post(begin);
  std::uint32_t released = 4;
  double least = kTop;
  w.runUntil([&] { return w.x(1) > 10; }, 60,
             [&] {
               const bool is_near = w.world.fleet().reached[0] + 2 > released;
               if (w.x(1) > 0.5) least = std::min(least, w.speed(1));
               if (!is_near || released > 13) return;
               FollowPath more = path({0.6}, released - 1);
               w.world.post(more);
               ++released;
             });
  EXPECT_GE(released, 12u);
  EXPECT_NEAR(least, 0.6, kExact);
}

TEST_F(SpeedLimitTest, APathWithoutLimitsIsDrivenAndHashedAsBefore) {
  FollowPath plain = path(std::vector<double>(6, kAny)), same = plain;
  plain.max_speed.clear();
  Warehouse other;
  other.spawn("kiva", "kiva1", 0, 0);
  w.world.post(same);
  other.world.post(plain);
  for (int k = 0; k < 3000; ++k) {
    w.step();
    other.step();
  }
  EXPECT_EQ(w.world.stateHash(), other.world.stateHash());
}

TEST_F(SpeedLimitTest, ACheckpointKeepsTheLimits) {
  w.world.post(path({kAny, kAny, 0.2, 0.2, kAny}));
  w.run(1);
  World other(parseWorld(worldText({}), modelPaths(), "test"));
  other.restore(w.world.checkpoint());
  w.run(8);
  for (int k = 0; k < 8000; ++k) other.step();
  EXPECT_EQ(w.world.stateHash(), other.stateHash());
}

TEST_F(SpeedLimitTest, WhatIsNoSpeedIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refused(path({0.0})).find("max_speed 0"), std::string::npos);
  EXPECT_NE(refused(path({-1.0})).find("max_speed -1"), std::string::npos);
  EXPECT_NE(refused(path({nan})).find("max_speed"), std::string::npos);
  FollowPath short_of = path({0.5, 0.5});
  short_of.max_speed.pop_back();
  EXPECT_NE(refused(short_of).find("3 x and 2 max_speed"), std::string::npos);
}

/// Returns by how much a robot is faster than the limits of its ways at most [m/s].
double excess(const Floorplan& plan, const std::string& kiva) {
  Warehouse w(plan);
  w.spawnText(kiva, "kiva1", 0, 0);
  const std::vector<double> speeds{kAny, kAny, kAny, 0.2, 0.2, kAny, kAny, kAny, 0.7, 0.3, kAny};
  FollowPath path;
  path.kiva_id = 1;
  path.path_id = 1;
  for (std::size_t k = 0; k <= speeds.size(); ++k) {
    path.x.push_back(static_cast<double>(k));
    path.y.push_back(0);
    path.max_speed.push_back(k == 0 ? kAny : speeds[k - 1]);
  }
  path.released = static_cast<std::uint32_t>(path.x.size());
  w.world.post(path);
  double most = -kTop;
  w.runUntil([&] { return w.status(1) == Status::kIdle && w.x(1) > 1; }, 120,
             [&] {
               const auto way = static_cast<std::size_t>(std::clamp(std::floor(w.x(1)), 0.0, 10.0));
               most = std::max(most, w.speed(1) - speeds[way]);
             });
  EXPECT_NEAR(w.x(1), 11, 0.02);
  return most;
}

Floorplan planWith(double step, const Realism& realism) {
  Floorplan plan{60, 1, step};
  plan.options.realism = realism;
  return plan;
}

TEST(SpeedLimitOfRealRobots, IsKeptByAllDrives) {
  const std::string kiva = modelText("kiva");
  EXPECT_LT(excess(Floorplan{60, 1, 0.01}, kiva), kExact);
  EXPECT_LT(excess({}, abruptKiva()), kExact);
  EXPECT_LT(excess({}, kivaText({{"drive", "jointed"}})), 0.02);
}

TEST(SpeedLimitOfRealRobots, IsKeptByMotorsThatLag) {
  Realism lagging;
  lagging.actuation = {true, 0.1, 0, 0};
  for (const double step : {0.001, 0.01}) {
    EXPECT_LT(excess(planWith(step, lagging), modelText("kiva")), 0.02) << step;
  }
}

TEST(SpeedLimitOfRealRobots, IsKeptByRobotsThatReckonWhereTheyAre) {
  Realism reckoning;
  reckoning.localisation.enabled = true;
  for (const double step : {0.001, 0.01}) {
    EXPECT_LT(excess(planWith(step, reckoning), modelText("kiva")), 0.02) << step;
  }
}

}  // namespace
}  // namespace kiva::test
