// SPDX-License-Identifier: Apache-2.0
//
// Turns in place: direction, angle and duration.
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr double kSlack = 0.02;  // [s]: start and coming to rest, beyond the profile

/// Returns the time from rest to rest over 90° [s].
double triangleTime(double acceleration) { return 2 * std::sqrt(kQuarter / acceleration); }

double turn(Warehouse& w, int direction) {
  w.rot(1, direction);
  return w.runUntilIdle(1);
}

TEST(Rotation, CounterclockwiseIsPositive) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 2, 1);
  turn(w, kLeft);
  EXPECT_NEAR(w.yaw(1), kQuarter, kHundredthDegree);
  turn(w, kRight);
  EXPECT_NEAR(w.yaw(1), 0, kHundredthDegree);
  turn(w, kRight);
  EXPECT_NEAR(w.yaw(1), -kQuarter, kHundredthDegree);
  w.expectAt(1, 2, 1);
}

TEST(Rotation, AQuarterTakesFiveEighthsOfASecond) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  for (int direction : {kLeft, kRight}) EXPECT_NEAR(turn(w, direction), 0.625, kSlack);
}

TEST(Rotation, AQuarterTakesTheTimeThatTheModelNames) {
  for (double time : {1.0, 2.5, 5.0}) {
    Warehouse w;
    w.spawnText(kivaText({{"quarter_turn_time", number(time)}}), "kiva1", 0, 0);
    EXPECT_NEAR(turn(w, kLeft), time, kSlack);
  }
}

TEST(Rotation, AQuarterInNoTimeIsAsFastAsTheGripOfTheWheelsAllows) {
  Warehouse w;
  w.spawnText(kivaText({{"quarter_turn_time", "0"}}), "kiva1", 0, 0);
  const double took = turn(w, kLeft);
  EXPECT_NEAR(w.yaw(1), kQuarter, kHundredthDegree);
  const double force = 0.8 * 145 * 9.81 * 0.8 / 2;  // of one wheel, 0.26 m off the centre [N]
  const double possible = triangleTime(2 * force * 0.26 / w.robot(1).inertia);
  EXPECT_GT(took, possible);
  EXPECT_LT(took, 1.1 * possible);
  EXPECT_EQ(w.count(Event::Kind::kDone), 1);
}

TEST(Rotation, AnInstantaneousRobotTurnsAtOnce) {
  Warehouse w;
  w.spawnText(kivaText({{"quarter_turn_time", "0"}, {"acceleration", "0"}}), "kiva1", 0, 0);
  EXPECT_LT(turn(w, kLeft), 0.01);
  EXPECT_NEAR(w.yaw(1), kQuarter, kHundredthDegree);
  EXPECT_EQ(w.count(Event::Kind::kDone), 1);
}

TEST(Rotation, FourQuartersComeBackAndAreCounted) {
  for (int direction : {kLeft, kRight}) {
    Warehouse w;
    w.spawn("kiva", "kiva1", 0, 0);
    for (int quarter = 1; quarter <= 4; ++quarter) {
      turn(w, direction);
      EXPECT_NEAR(w.yaw(1), direction * quarter * kQuarter, kHundredthDegree);
    }
    w.expectAt(1, 0, 0);
    EXPECT_NEAR(w.world.basePose(w.index(1)).Rot().Yaw(), 0, kHundredthDegree);
  }
}

TEST(Rotation, ReportsRotatingAndEnds) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.forget();
  turn(w, kLeft);
  EXPECT_EQ(w.statesOf(1), (std::vector<State>{State::kRotating, State::kIdle}));
  EXPECT_EQ(w.kindsOf("kiva1"),
            (std::vector<Event::Kind>{Event::Kind::kAccepted, Event::Kind::kDone}));
}

TEST(Rotation, HundredTurnsStayOnTheGrid) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  for (int i = 0; i < 100; ++i) {
    turn(w, i % 7 < 4 ? kLeft : kRight);
    w.expectOnGrid(1);
  }
}

TEST(Rotation, AHeavyUnitTurnsSlowerSinceTheMotorsAreLimited) {
  constexpr double kUnitInertia = 48;  // [kg m²]: 450 kg spread over 0.8 × 0.8 m
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  std::string unit = withParameter(unitOfMass(450), "izz", number(kUnitInertia));
  unit = withParameter(withParameter(unit, "ixx", "100"), "iyy", "100");
  w.spawnText(unit, "storage_unit1", 0, 0);
  w.carry(1, 1);
  w.runUntilIdle(1);
  const double took = turn(w, kLeft);
  w.expectOnGrid(1);
  // Two motors of 90 Nm push 0.26 m off the centre with 900 N each.
  const double robot_inertia = w.robot(1).inertia;
  const double possible = 2 * 900 * 0.26 / (robot_inertia + kUnitInertia);
  EXPECT_GT(took, triangleTime(possible));
  EXPECT_LT(took, 1.15 * triangleTime(possible));
}

TEST(Rotation, ToDriveTheRobotTurnsTheShorterWay) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.movy(1, -1);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.yaw(1), -kQuarter, kHundredthDegree);
  w.movx(1, -1);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.yaw(1), -2 * kQuarter, kHundredthDegree);
  w.movx(1, 2);  // straight behind: to the left
  w.runUntilIdle(1);
  EXPECT_NEAR(w.yaw(1), 0, kHundredthDegree);
}

TEST(Rotation, ARobotOnAnIceRinkGivesUpAndIsIdleAgain) {
  Warehouse w;
  w.spawnText(kivaText({{"friction", "0"}}), "kiva1", 0, 0);
  turn(w, kLeft);
  EXPECT_EQ(w.count(Event::Kind::kBlocked, "kiva1"), 1);
  EXPECT_PRED2(contains, w.last(Event::Kind::kBlocked).text, "stuck");
  w.movx(1, 1);
  w.runUntilIdle(1);
  EXPECT_EQ(w.count(Event::Kind::kBlocked, "kiva1"), 2);
}

}  // namespace
}  // namespace kiva::test
