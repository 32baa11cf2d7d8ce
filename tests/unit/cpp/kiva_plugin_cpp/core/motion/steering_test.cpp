// SPDX-License-Identifier: Apache-2.0
//
// Robots that clients drive by velocities: how they accelerate, turn and stop, what stops them, and
// how they come back to the grid.
#include <algorithm>
#include <random>
#include <stdexcept>

#include "core/geometry/swept_arc.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kSpeed = 1.5, kAcceleration = 1, kSilence = 0.5;  // [m/s, m/s², s]

Realism wheelsThatSlip() {
  Realism realism;
  realism.localisation.enabled = true;
  return realism;
}

class Steered : public ::testing::Test {
 protected:
  explicit Steered(const WorldOptions& options = {}) : w(Floorplan{40, 1, 0.001, "", options}) {
    w.spawn("kiva", "kiva1", 0, 0);
    w.world.beginSteering(1);
    w.step();
    w.forget();
  }

  /// Asks for that velocity, again and again, for a duration [s].
  void drive(double speed, double turn_rate, double duration,
             const std::function<void()>& each = {}) {
    w.run(duration, [&] {
      w.world.steer(1, speed, turn_rate);
      if (each) each();
    });
  }

  /// Asks it to stop, and waits until it stands.
  void halt() {
    drive(0, 0, 0.01);
    w.runUntil([&] { return w.speed(1) < 1e-6 && std::abs(turnRate()) < 1e-6; }, 5);
  }

  double turnRate() const { return w.world.fleet().yaw_rate[w.index(1)]; }
  std::string whyNot(const std::function<void()>& act) {
    try {
      act();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }

  Warehouse w;
};

// --- velocities

TEST_F(Steered, DriveAtTheSpeedAskedForWithTheirAcceleration) {
  double fastest = 0, last = 0;
  drive(1, 0, 3, [&] {
    fastest = std::max(fastest, std::abs(w.speed(1) - last) / 0.001);
    last = w.speed(1);
  });
  EXPECT_NEAR(w.speed(1), 1, 1e-6);
  EXPECT_LT(fastest, kAcceleration * 1.001);
  EXPECT_NEAR(w.x(1), 3 - 0.5 * 1 * 1 / kAcceleration, 0.005);  // v²/2a is lost
  EXPECT_NEAR(w.y(1), 0, 1e-9);
}

TEST_F(Steered, DriveAnArcOfTheRadiusThatSpeedAndTurnRateMake) {
  drive(0.5, 0.5, 2);  // steady
  const double x = w.x(1), y = w.y(1), yaw = w.yaw(1);
  const double cx = x - std::sin(yaw), cy = y + std::cos(yaw);  // 1 m to its left
  double off = 0;
  drive(0.5, 0.5, 2 * M_PI / 0.5,
        [&] { off = std::max(off, std::abs(std::hypot(w.x(1) - cx, w.y(1) - cy) - 1)); });
  EXPECT_LT(off, 0.002);
  EXPECT_NEAR(std::hypot(w.x(1) - x, w.y(1) - y), 0, 0.002);
  EXPECT_NEAR(w.yaw(1) - yaw, 2 * M_PI, 0.002);
}

TEST_F(Steered, ClampWhatExceedsTheirLimits) {
  drive(1e6, 0, 3);
  EXPECT_NEAR(w.speed(1), kSpeed, 1e-6);
  EXPECT_PRED2(contains, w.world.takeWarnings().at(0), "it drives at most 1.5 m/s ahead");
  drive(-1e6, 0, 4);
  EXPECT_NEAR(w.world.fleet().vx[0], -0.3, 1e-6);  // no laser looks back
  drive(0, 1e9, 2);
  EXPECT_NEAR(turnRate(), M_PI / 0.625, 1e-3);
  EXPECT_TRUE(w.world.takeWarnings().empty()) << "it is told once";
}

TEST_F(Steered, HoldOnTheirArcAtAnySpeed) {
  double off = 0;
  drive(kSpeed, 5, 3, [&] {
    const double c = std::cos(w.yaw(1)), s = std::sin(w.yaw(1));
    off = std::max(off, std::abs(c * w.world.fleet().vy[0] - s * w.world.fleet().vx[0]));
  });
  EXPECT_LT(off, 0.003) << "it slides sideways";  // the chassis turns a little in each step
  EXPECT_NEAR(turnRate() / w.speed(1), 5 / kSpeed, 0.01) << "it drives another arc";
}

TEST_F(Steered, RefuseVelocitiesThatAreNotFinite) {
  drive(0.5, 0, 1);
  for (const auto& [speed, turn] : {std::pair{kNan, 0.0}, {0.5, kInfinite}, {-kInfinite, kNan}}) {
    EXPECT_PRED2(contains, whyNot([&] { w.world.steer(1, speed, turn); }), "kiva1: a velocity of");
  }
  w.step();
  EXPECT_NEAR(w.speed(1), 0.5, 1e-6);
}

TEST_F(Steered, StopWhenNothingIsHeardForHalfASecond) {
  drive(1, 0.2, 2);
  w.run(kSilence - 0.01);
  EXPECT_NEAR(w.speed(1), 1, 1e-6);
  w.run(1.1);
  EXPECT_LT(w.speed(1), 1e-9);
  EXPECT_LT(std::abs(turnRate()), 1e-9);
  EXPECT_EQ(w.status(1), Status::kBusy);
  EXPECT_EQ(w.state(1), State::kSteered);
}

TEST_F(Steered, StandStillAndGoOnWithStopAndItsEnd) {
  Command stop;
  stop.kind = Command::Kind::kStop;
  stop.kiva_id = 1;
  drive(1, 0, 2);
  w.world.post(stop);
  drive(1, 0, 1);
  EXPECT_LT(w.speed(1), 1e-9);
  stop.kind = Command::Kind::kGoOn;
  w.world.post(stop);
  drive(1, 0, 2);
  EXPECT_NEAR(w.speed(1), 1, 1e-6);
}

TEST_F(Steered, StandWithoutAMotor) {
  drive(1, 0.5, 2);
  w.world.fail(1, Failure::kMotor, 0);
  drive(1, 0.5, 3);
  EXPECT_LT(w.speed(1), 1e-6);
  w.world.repair(1);
  drive(1, 0, 2);
  EXPECT_NEAR(w.speed(1), 1, 1e-6);
}

// --- obstacles

TEST_F(Steered, StopBeforeAWallAndSayBlocked) {
  w.spawn("wall", "wall", 6, 0);
  drive(kSpeed, 0, 8);
  EXPECT_LT(w.speed(1), 1e-9);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
  EXPECT_EQ(w.count(Kind::kBlocked, "kiva1"), 1);
  EXPECT_EQ(w.last(Kind::kBlocked).other, "wall");
  EXPECT_EQ(w.last(Kind::kBlocked).text, "wall is in the way");
  EXPECT_EQ(w.status(1), Status::kBlocked);
  const double gap = w.world.rayCast({w.x(1), 0, 0.2}, 0, 5, "kiva1") - 0.38;
  EXPECT_NEAR(gap, 0.05, 0.005);
  drive(-0.2, 0, 1);
  EXPECT_EQ(w.status(1), Status::kBusy);
  EXPECT_LT(w.world.fleet().vx[0], -0.19) << "it may go back";
}

TEST_F(Steered, StopBeforeARobotThatStands) {
  w.spawn("kiva", "kiva2", 5, 0);
  drive(kSpeed, 0, 8);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
  EXPECT_NEAR(w.x(2) - w.x(1), 2 * 0.38 + 0.05, 0.005);
}

TEST_F(Steered, StopBeforeARobotThatComesTowardsThem) {
  for (const double offset : {0.0, 0.1, -0.2}) {
    Warehouse other(Floorplan{40});
    other.spawn("kiva", "kiva1", 0, offset);
    other.spawn("kiva", "kiva2", 12, 0, M_PI);
    other.world.beginSteering(1);
    other.movx(2, -12);
    other.run(10, [&] { other.world.steer(1, kSpeed, 0); });
    EXPECT_EQ(other.count(Kind::kCollision), 0) << offset;
    EXPECT_LT(other.speed(1), 1e-6) << offset;
  }
}

TEST_F(Steered, GoOnOnceTheWayIsFree) {
  w.spawn("wall", "wall", 4, 0);
  drive(1, 0, 6);
  ASSERT_EQ(w.status(1), Status::kBlocked);
  w.world.remove("wall");
  drive(1, 0, 2);
  EXPECT_EQ(w.status(1), Status::kBusy);
  EXPECT_NEAR(w.speed(1), 1, 1e-6);
}

TEST_F(Steered, PassAnObstacleBesideTheirArc) {
  w.spawnText(modelText("unknown_obstacle"), "box", 3, 0);
  drive(0.5, 0.25, 3 * M_PI);  // a circle of 2 m to its left passes the box by more than a metre
  EXPECT_EQ(w.count(Kind::kBlocked), 0);
  EXPECT_NEAR(w.speed(1), 0.5, 1e-6);
}

TEST_F(Steered, StopOnAnArcBeforeWhatStandsOnIt) {
  const double x = 2 * std::sin(1.2), y = 2 - 2 * std::cos(1.2);
  w.spawn("kiva", "kiva2", x, y, 1.2);
  drive(1, 0.5, 6);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
  EXPECT_EQ(w.status(1), Status::kBlocked);
  EXPECT_LT(w.speed(1), 1e-6);
}

TEST_F(Steered, DriveBeneathAUnitInItsMiddleAndStopBeforeItsLegs) {
  w.spawn("storage_unit", "storage_unit1", 3, 0);
  w.spawn("storage_unit", "storage_unit2", 3, 3);
  drive(1, 0, 5);
  EXPECT_GT(w.x(1), 4);
  EXPECT_EQ(w.count(Kind::kBlocked), 0);
  Warehouse other(Floorplan{40});
  other.spawn("kiva", "kiva1", 0, 0.2);
  other.spawn("storage_unit", "storage_unit1", 3, 0);
  other.world.beginSteering(1);
  other.run(6, [&] { other.world.steer(1, 1, 0); });
  EXPECT_EQ(other.count(Kind::kCollision), 0);
  EXPECT_NEAR(other.x(1), 3 - 0.4 - 0.38 - 0.05, 0.01);
}

TEST_F(Steered, NeverHitWhatStandsStillInARandomDrive) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> speed(-0.3, 1.5), turn(-1.5, 1.5);
  Warehouse other(Floorplan{40});
  other.spawn("kiva", "kiva1", 0, 0);
  int number = 1;
  for (int x = -8; x <= 8; x += 4) {
    for (int y = -8; y <= 8; y += 4) {
      if (x != 0 || y != 0) other.spawn("kiva", "kiva" + std::to_string(++number), x, y);
    }
  }
  other.world.beginSteering(1);
  int ahead = 0;
  for (int part = 0; part < 200; ++part) {
    // Behind and beside it sees nothing: it drives ahead, along arcs that its front passes first.
    const double v = std::max(0.2, speed(random)), w = std::min(1.0, v) * turn(random) / 2;
    other.run(1, [&] { other.world.steer(1, v, w); });
    ahead += other.status(1) == Status::kBlocked;
    if (other.status(1) == Status::kBlocked) {
      other.run(2, [&] { other.world.steer(1, 0, 0); });
      other.run(1, [&] { other.world.steer(1, -0.2, 0); });
    }
  }
  EXPECT_EQ(other.count(Kind::kCollision), 0);
  EXPECT_GT(ahead, 0);
}

TEST_F(Steered, StandAfterACollisionUntilTheyAreAskedToStop) {
  w.spawn("wall", "wall", -1.5, 0);
  drive(-0.3, 0, 6);  // blind behind
  ASSERT_EQ(w.count(Kind::kCollision), 1);
  EXPECT_EQ(w.status(1), Status::kBlocked);
  EXPECT_LT(w.speed(1), 1e-3);
  drive(0.5, 0, 1);
  EXPECT_LT(w.speed(1), 1e-3);
  drive(0, 0, 0.1);
  drive(0.5, 0, 1);
  EXPECT_NEAR(w.speed(1), 0.5, 1e-3);
  EXPECT_EQ(w.status(1), Status::kBusy);
}

TEST_F(Steered, StopBeforeAPerson) {
  w.spawn("person", "person1", 8, 0);
  Walk walk;
  walk.waypoints.push_back({8, 0});
  w.world.walk("person1", walk);
  drive(kSpeed, 0, 12);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
  EXPECT_LT(w.speed(1), 1e-6);
  EXPECT_LT(w.x(1), 8 - 0.38 - 0.3);
}

// --- commands meanwhile, and the way back to the grid

TEST_F(Steered, RefuseCommandsAlongTheGridWithAWayOut) {
  w.movx(1, 1);
  EXPECT_PRED2(contains, w.refusal(),
               "it is driven by /kiva1/cmd_vel: give it back to the grid first");
  w.rot(1, kLeft);
  EXPECT_PRED2(contains, w.refusal(), "it is driven by /kiva1/cmd_vel");
  Command cancel;
  cancel.kind = Command::Kind::kCancel;
  cancel.kiva_id = 1;
  w.world.post(cancel);
  EXPECT_PRED2(contains, w.refusal(), "it is driven by /kiva1/cmd_vel");
  EXPECT_EQ(w.state(1), State::kSteered);
}

TEST_F(Steered, AreGivenBackOnAGridPointOnly) {
  drive(0.5, 0, 1);
  EXPECT_PRED2(contains, whyNot([&] { w.world.endSteering(1); }), "ask it to stop first");
  halt();
  EXPECT_PRED2(contains, whyNot([&] { w.world.endSteering(1); }), "m off the grid point");
  w.run(1);
  const double left = 1.02 - w.x(1);
  w.runUntil(
      [&] {
        w.world.steer(1, std::min(0.2, std::sqrt(2 * std::max(0.0, 1.02 - w.x(1)))), 0);
        return w.x(1) > 1.01;
      },
      20);
  halt();
  EXPECT_GT(left, 0);
  w.world.endSteering(1);
  EXPECT_EQ(w.status(1), Status::kIdle);
  w.movx(1, 2);
  w.runUntilIdle(1);
  w.expectAt(1, 3, 0);
  EXPECT_EQ(w.count(Kind::kDone, "kiva1"), 1);
}

TEST_F(Steered, AreNotGivenBackAskew) {
  w.runUntil([&] {
    w.world.steer(1, 0, 0.3);
    return w.yaw(1) > 0.3;
  });
  halt();
  const std::string why = whyNot([&] { w.world.endSteering(1); });
  EXPECT_PRED2(contains, why, "18° off the heading of 0°");
  EXPECT_PRED2(contains, why, "drive it to less than 0.05 m and 5° first");
}

TEST_F(Steered, AreTakenOnlyWhileIdle) {
  EXPECT_PRED2(contains, whyNot([&] { w.world.beginSteering(1); }), "it takes velocities already");
  EXPECT_PRED2(contains, whyNot([&] { w.world.beginSteering(7); }), "there is no robot kiva7");
  EXPECT_PRED2(contains, whyNot([&] { w.world.steer(7, 1, 0); }), "there is no robot kiva7");
  w.spawn("kiva", "kiva2", 0, 5);
  EXPECT_PRED2(contains, whyNot([&] { w.world.steer(2, 1, 0); }), "kiva2: it takes no velocities");
  EXPECT_PRED2(contains, whyNot([&] { w.world.endSteering(2); }), "it takes no velocities");
  w.movx(2, 3);
  w.step();
  EXPECT_PRED2(contains, whyNot([&] { w.world.beginSteering(2); }), "it carries out a command");
}

TEST_F(Steered, MayLoseTheObstacleBeforeThem) {
  w.spawn("wall", "wall", 4, 0);
  w.runUntil([&] {
    w.world.steer(1, 1, 0);
    return w.x(1) > 1.9;
  });
  w.world.remove("wall");
  drive(1, 0, 0.05);
  Warehouse other(Floorplan{40});
  other.world.restore(w.world.checkpoint());
  drive(1, 0, 2);
  EXPECT_NEAR(w.speed(1), 1, 1e-6);
}

TEST_F(Steered, DriveOnRealWheelJointsAsWell) {
  WorldOptions options;
  options.drive = Drive::kJointed;
  Warehouse other(Floorplan{40, 1, 0.001, "", options});
  other.spawn("kiva", "kiva1", 0, 0);
  other.world.beginSteering(1);
  other.run(3, [&] { other.world.steer(1, 1, 0.2); });
  EXPECT_NEAR(other.speed(1), 1, 0.02);
  EXPECT_NEAR(other.world.fleet().yaw_rate[0], 0.2, 0.01);
  other.run(2);
  EXPECT_LT(other.speed(1), 1e-3);
}

TEST_F(Steered, MayBeDeleted) {
  drive(1, 0, 1);
  w.spawn("kiva", "kiva2", 0, 5);
  w.world.remove("kiva1");
  w.run(0.1);
  EXPECT_TRUE(w.world.steeredRobots().empty());
  w.movx(2, 1);
  w.runUntilIdle(2);
  w.expectAt(2, 1, 5);
}

// --- odometry

TEST_F(Steered, CountTheirWayFromWhereTheyWereHandedOver) {
  Warehouse other(Floorplan{40});
  other.spawn("kiva", "kiva1", 3, -2, M_PI / 2);
  other.world.beginSteering(1);
  other.run(4, [&] { other.world.steer(1, 0.5, 0.3); });
  const Odometry odometry = other.world.odometry(0);
  EXPECT_TRUE(odometry.is_local);
  EXPECT_NEAR(odometry.pose.X(), other.y(1) + 2, 1e-9);
  EXPECT_NEAR(odometry.pose.Y(), 3 - other.x(1), 1e-9);
  EXPECT_NEAR(odometry.pose.Z(), other.yaw(1) - M_PI / 2, 1e-9);
  EXPECT_EQ(odometry.pose_covariance[0], 0);
}

TEST_F(Steered, CountOnWhereAHandPutsThem) {
  drive(1, 0, 2);
  const Vector3 before = w.world.odometry(0).pose;
  w.world.setState("kiva1", {Pose(-5, -5, 0, 0, 0, 1), {}});
  w.step();
  EXPECT_LT((w.world.odometry(0).pose - before).Length(), 1e-4);
  EXPECT_EQ(w.state(1), State::kSteered);
  w.world.reset(false);
  EXPECT_LT(w.world.odometry(0).pose.Length(), 1e-9);
  EXPECT_EQ(w.state(1), State::kSteered);
}

TEST(SteeredWithRealWheels, DriftAsTheirCovarianceSays) {
  int within = 0;
  constexpr int kRobots = 40;
  double farthest = 0, likelihood = 0;
  for (int seed = 1; seed <= kRobots; ++seed) {
    WorldOptions options;
    options.seed = seed;
    options.realism = wheelsThatSlip();
    Warehouse w(Floorplan{60, 1, 0.001, "", options});
    w.spawn("kiva", "kiva1", -20, 0);
    w.world.beginSteering(1);
    const Pose start = w.world.basePose(0);
    w.run(30, [&] { w.world.steer(1, 1, 0.05 * std::sin(w.world.time())); });
    EXPECT_EQ(w.count(Kind::kLost), 0) << "it reads no codes, but its client locates it";
    const Odometry odometry = w.world.odometry(0);
    const Pose counted = start * Pose(odometry.pose.X(), odometry.pose.Y(), 0, 0, 0, 0);
    const double off = counted.Pos().Distance(w.world.basePose(0).Pos());
    farthest = std::max(farthest, off);
    const double across = counted.Y() - w.world.basePose(0).Y();
    likelihood += across * across / odometry.pose_covariance[4] / kRobots;
    within += std::abs(across) < 2 * std::sqrt(odometry.pose_covariance[4]);
  }
  EXPECT_GT(farthest, 0.1);
  EXPECT_LT(farthest, 3);
  EXPECT_GT(within, kRobots * 0.8);
  EXPECT_GT(likelihood, 0.4);
  EXPECT_LT(likelihood, 2);
}

TEST(SteeredWithRealWheels, DriftInTurnsAsTheirCovarianceSays) {
  constexpr int kRobots = 40;
  double likelihood[2] = {0, 0};
  for (int seed = 1; seed <= kRobots; ++seed) {
    WorldOptions options;
    options.seed = seed;
    options.realism = wheelsThatSlip();
    Warehouse w(Floorplan{60, 1, 0.001, "", options});
    w.spawn("kiva", "kiva1", 0, 0);
    w.world.beginSteering(1);
    w.run(20, [&] { w.world.steer(1, 0, 3); });  // some 60 rad, in place
    w.run(4, [&] { w.world.steer(1, 1, 0); });
    const Odometry odometry = w.world.odometry(0);
    const double yaw_off = std::remainder(odometry.pose.Z() - w.yaw(1), 2 * M_PI);
    likelihood[0] += yaw_off * yaw_off / odometry.pose_covariance[8] / kRobots;
    // Across its last, straight way.
    const double c = std::cos(w.yaw(1)), s = std::sin(w.yaw(1));
    const double across = c * (odometry.pose.Y() - w.y(1)) - s * (odometry.pose.X() - w.x(1));
    const double variance = s * s * odometry.pose_covariance[0] +
                            c * c * odometry.pose_covariance[4] -
                            2 * s * c * odometry.pose_covariance[1];
    likelihood[1] += across * across / variance / kRobots;
  }
  for (const double share : likelihood) {
    EXPECT_GT(share, 0.5);
    EXPECT_LT(share, 1.7);
  }
}

TEST(SteeredWithRealWheels, KnowTheirPlaceOnceTheyAreBack) {
  WorldOptions options;
  options.realism = wheelsThatSlip();
  Warehouse w(Floorplan{60, 1, 0.001, "", options});
  w.spawn("kiva", "kiva1", -20, 0);
  w.world.beginSteering(1);
  w.run(30, [&] { w.world.steer(1, 1, 0); });
  w.run(2);
  w.world.setState("kiva1", {Pose(5, 3.01, 0, 0, 0, 0.01), {}});
  w.world.endSteering(1);
  w.movx(1, 2);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.x(1), 7, 0.01);
  EXPECT_NEAR(w.y(1), 3, 0.01);
}

// --- checkpoints

TEST_F(Steered, GoOnFromACheckpointBitByBit) {
  drive(1, 0.3, 1.5);
  const std::string saved = w.world.checkpoint();
  Warehouse other(Floorplan{40});
  other.world.restore(saved);
  EXPECT_EQ(other.world.stateHash(), w.world.stateHash());
  drive(0.7, -0.2, 2);
  other.run(2, [&] { other.world.steer(1, 0.7, -0.2); });
  EXPECT_EQ(other.world.stateHash(), w.world.stateHash());
  EXPECT_EQ(other.world.steeredRobots(), std::vector<int>{1});
}

// --- the area of an arc

TEST(SweptArc, MeetsAPointWhereARectangleThatIsMovedInStepsDoes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> along(0.4, 3), across(-1.5, 1.5), bend(-1, 1);
  constexpr double kLength = 0.38, kWidth = 0.32, kStep = 0.002;
  int met = 0;
  for (int k = 0; k < 2000; ++k) {
    const double x = along(random), y = across(random), curvature = bend(random);
    double expected = kInfinite;
    const double most = std::abs(curvature) < 0.01 ? 5 : std::min(5.0, 3.0 / std::abs(curvature));
    for (double way = 0; way < most && std::isinf(expected); way += kStep) {
      const double yaw = way * curvature;
      const double cx = std::abs(curvature) < 1e-9 ? way : std::sin(yaw) / curvature;
      const double cy = std::abs(curvature) < 1e-9 ? 0 : (1 - std::cos(yaw)) / curvature;
      const double dx = std::cos(yaw) * (x - cx) + std::sin(yaw) * (y - cy);
      const double dy = std::cos(yaw) * (y - cy) - std::sin(yaw) * (x - cx);
      if (std::abs(dx) < kLength && std::abs(dy) < kWidth) expected = way;
    }
    const double way = wayToPoint({curvature, kLength, kWidth}, x, y);
    if (std::isinf(expected)) {
      EXPECT_GT(way, most - 0.01) << curvature << ", point " << x << ", " << y;
    } else {
      EXPECT_NEAR(way, expected, 2 * kStep) << curvature << ", point " << x << ", " << y;
      ++met;
    }
  }
  EXPECT_GT(met, 300);
}

}  // namespace
}  // namespace kiva::test
