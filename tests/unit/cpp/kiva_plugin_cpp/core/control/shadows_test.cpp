// SPDX-License-Identifier: Apache-2.0
//
// Shadows of robots that are elsewhere: their poses and loads, and their visibility to other
// robots.
#include "warehouse.h"

namespace kiva::test {
namespace {

ShadowReport at(double x, double y, double yaw = 0) {
  ShadowReport out;
  out.report.x = x;
  out.report.y = y;
  out.report.yaw = yaw;
  return out;
}

class Shadows : public ::testing::Test {
 protected:
  Shadows() {
    w.spawn("kiva", "kiva1", 0, 0);
    w.spawn("kiva", "kiva2", 0, 5);
    w.spawn("storage_unit", "storage_unit1", 3, 5);
    w.forget();
  }

  Warehouse w;
};

TEST_F(Shadows, StandsWhereItIsTold) {
  w.world.shadow(2, at(1.3, 4.2, 0.5));
  w.run(1);
  EXPECT_EQ(w.x(2), 1.3);
  EXPECT_EQ(w.y(2), 4.2);
  EXPECT_EQ(w.yaw(2), 0.5);
  EXPECT_TRUE(w.world.isShadow(2));
  EXPECT_FALSE(w.world.isShadow(1));
}

TEST_F(Shadows, TellsWhatItIsTold) {
  ShadowReport report = at(0, 5);
  report.report.status = Status::kBusy;
  report.report.state = State::kWaiting;
  report.report.path_id = 7;
  report.report.reached = 3;
  report.report.left = 2;
  report.failures = bitOf(Failure::kMotor);
  report.charge = 0.5;
  w.world.shadow(2, report);
  w.run(1);
  const Fleet& f = w.world.fleet();
  const int i = f.find(2);
  EXPECT_EQ(w.status(2), Status::kBusy);
  EXPECT_EQ(w.state(2), State::kWaiting);
  EXPECT_EQ(f.path_id[i], 7u);
  EXPECT_EQ(f.reached[i], 3u);
  EXPECT_EQ(f.left[i], 2u);
  EXPECT_EQ(f.failures[i], bitOf(Failure::kMotor));
  EXPECT_EQ(f.charge[i], 0.5f);
}

TEST_F(Shadows, TellsItsVelocityAndStandsUntilTheNextReport) {
  EXPECT_FALSE(w.world.shadowTwist(w.world.fleet().find(2)));
  ShadowReport report = at(0, 5);
  report.report.vx = 1.5;
  report.report.yaw_rate = 0.2;
  w.world.shadow(2, report);
  w.run(1);
  const auto twist = w.world.shadowTwist(w.world.fleet().find(2));
  ASSERT_TRUE(twist);
  EXPECT_EQ(twist->vx, 1.5);
  EXPECT_EQ(twist->vy, 0);
  EXPECT_EQ(twist->yaw_rate, 0.2);
  EXPECT_EQ(w.x(2), 0);
}

TEST_F(Shadows, RefusesWhatNoRobotCanReport) {
  const double nan = std::nan("");
  EXPECT_THROW(w.world.shadow(2, at(nan, 5)), std::invalid_argument);
  EXPECT_THROW(w.world.shadow(2, at(1e300, 5)), std::runtime_error);
  ShadowReport report = at(0, 5);
  for (const float charge : {-0.1f, 1.1f, static_cast<float>(nan)}) {
    report.charge = charge;
    EXPECT_THROW(w.world.shadow(2, report), std::invalid_argument);
  }
  report = at(0, 5);
  report.report.vy = nan;
  EXPECT_THROW(w.world.shadow(2, report), std::invalid_argument);
  report = at(0, 5);
  report.report.last_end = 255;
  EXPECT_THROW(w.world.shadow(2, report), std::invalid_argument);
  w.run(1);
  EXPECT_EQ(w.y(2), 5);
  EXPECT_FALSE(w.world.isShadow(2));
}

TEST_F(Shadows, LeavesCommandsToOthers) {
  w.world.shadow(2, at(0, 5));
  w.movx(2, 2);
  w.run(2);
  EXPECT_EQ(w.x(2), 0);
  EXPECT_TRUE(w.events.empty());
  EXPECT_TRUE(w.events.empty());
  w.movx(1, 2);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.x(1), 2, kMillimetre);
}

TEST_F(Shadows, EndsWhatTheRobotDid) {
  w.movx(2, 5);
  w.run(2);
  w.world.shadow(2, at(1, 5));
  w.run(2);
  EXPECT_EQ(w.x(2), 1);
  EXPECT_EQ(w.status(2), Status::kIdle);
}

TEST_F(Shadows, IsSeenByOthersLasers) {
  w.world.shadow(2, at(4, 0));
  w.movx(1, 8);
  w.runUntilIdle(1);
  EXPECT_GT(w.x(1), 2);
  EXPECT_LT(w.x(1), 3.3);
  w.world.shadow(2, at(4, 3));
  w.movx(1, 3);
  w.runUntilIdle(1);
  EXPECT_GT(w.x(1), 4);
}

TEST_F(Shadows, TakesItsLoadAlongAndPutsItDown) {
  ShadowReport loaded = at(3, 5);
  loaded.report.shelf_id = 1;
  w.world.shadow(2, loaded);
  EXPECT_EQ(w.loadOf(2), 1);
  EXPECT_GE(w.unitPose(1).Z(), 0.05);
  loaded.report.x = 4;
  w.world.shadow(2, loaded);
  w.run(1);
  EXPECT_NEAR(w.unitPose(1).X(), 4, kMillimetre);
  w.world.shadow(2, at(5, 5));
  w.run(1);
  EXPECT_EQ(w.carrierOf(1), 0);
  EXPECT_EQ(w.unitPose(1).Z(), 0);
  EXPECT_EQ(w.tower(2), 0);
}

TEST_F(Shadows, RefusesWhatCannotBe) {
  ShadowReport other = at(0, 0);
  EXPECT_THROW(w.world.shadow(9, other), std::invalid_argument);
  other.report.x = NAN;
  EXPECT_THROW(w.world.shadow(2, other), std::invalid_argument);
  other = at(0, 5);
  other.report.shelf_id = 9;
  EXPECT_THROW(w.world.shadow(2, other), std::invalid_argument);
  EXPECT_FALSE(w.world.isShadow(2));
}

TEST_F(Shadows, GoesWithItsRobot) {
  w.world.shadow(2, at(0, 5));
  w.world.remove("kiva2");
  w.spawn("kiva", "kiva2", 0, 5);
  w.movx(2, 1);
  w.runUntilIdle(2);
  EXPECT_NEAR(w.x(2), 1, kMillimetre);
}

TEST_F(Shadows, StaysOneAfterARestore) {
  const std::string before = w.world.checkpoint();
  w.world.shadow(2, at(1, 5));
  w.world.restore(before);
  EXPECT_TRUE(w.world.isShadow(2));
}

}  // namespace
}  // namespace kiva::test
