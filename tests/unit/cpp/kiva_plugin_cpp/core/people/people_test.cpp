// SPDX-License-Identifier: Apache-2.0
//
// People walk among robots: no robot touches a person, and all reach their goals.
#include <algorithm>
#include <cmath>
#include <limits>

#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;

constexpr double kRadius = 0.25;     // of a person [m]
constexpr double kBraking = 2.5;     // of a robot for people's sake [m/s²]
constexpr double kScanPeriod = 0.1;  // [s]

Walk through(std::vector<Waypoint> waypoints) { return {std::move(waypoints), false}; }

class People : public ::testing::Test {
 protected:
  People() {
    w.spawn("kiva", "kiva1", 0, 0);
    w.spawn("person", "person1", 5, -4.4);
    w.forget();
  }

  Person person() const { return w.world.people().at(0); }
  Pose pose() const { return w.world.state("person1")->pose; }

  /// Returns the distance of the person ahead of the robot [m].
  double ahead() const {
    return std::cos(w.yaw(1)) * (pose().X() - w.x(1)) + std::sin(w.yaw(1)) * (pose().Y() - w.y(1));
  }
  double beside() const {
    return std::cos(w.yaw(1)) * (pose().Y() - w.y(1)) - std::sin(w.yaw(1)) * (pose().X() - w.x(1));
  }
  /// Returns the distance between the person and the robot's chassis [m].
  double gap() const {
    const Robot& robot = w.robot(1);
    const double along = std::max(0.0, std::abs(ahead()) - robot.half_length);
    const double across = std::max(0.0, std::abs(beside()) - robot.half_width);
    return std::hypot(along, across) - kRadius;
  }
  /// Expects that a person in the robot's way is farther away than its stopping distance.
  void expectThatItCanStop() const {
    const bool is_in_lane = std::abs(beside()) < w.robot(1).half_width + kRadius;
    if (!is_in_lane || ahead() < 0) return;
    const double speed = w.speed(1);
    EXPECT_GE(gap() + 1e-3, speed * speed / (2 * kBraking)) << "at " << w.world.time() << " s";
  }
  void follow(double distance) {
    FollowPath path;
    path.kiva_id = 1;
    path.path_id = ++paths_;
    const double c = std::round(std::cos(w.yaw(1))), s = std::round(std::sin(w.yaw(1)));
    for (int k = 0; k <= distance; ++k) {
      path.x.push_back(std::round(w.x(1)) + c * k);
      path.y.push_back(std::round(w.y(1)) + s * k);
    }
    path.released = static_cast<std::uint32_t>(path.x.size());
    w.world.post(path);
    w.step();
  }
  std::string refusalOf(const std::string& name, const Walk& walk) {
    const std::uint64_t before = w.world.stateHash();
    try {
      w.world.walk(name, walk);
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(w.world.stateHash(), before);
      return error.what();
    }
    return "";
  }

  Warehouse w{Floorplan{40}};

 private:
  std::uint32_t paths_ = 0;
};

TEST_F(People, WhoCrossBeforeARobotAreNotTouchedAndItGoesOn) {
  follow(10);
  w.world.walk("person1", through({{5, 4.4}}));
  double least = 1e9, slowest = 1e9;
  w.runUntilIdle(1, 60, [&] {
    least = std::min(least, gap());
    if (w.x(1) > 2 && w.x(1) < 8) slowest = std::min(slowest, w.speed(1));
    expectThatItCanStop();
  });
  EXPECT_GT(least, 0.3);
  EXPECT_LT(least, 1.5);  // they came near each other
  EXPECT_LT(slowest, 0.5);
  w.expectAt(1, 10, 0);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
  EXPECT_EQ(w.last(Kind::kDone).command, 1u);
  EXPECT_EQ(w.world.fleet().allowed_speed[0], std::numeric_limits<double>::infinity());
}

TEST_F(People, WhoWalkTowardsARobotMakeItStandInGoodTime) {
  w.world.setState("person1", {Pose(9, 0, 0, 0, 0, M_PI), {}});
  follow(12);
  w.world.walk("person1", through({{1, 0}}));
  double least = 1e9, slowest = 1e9;
  w.run(4.5, [&] {
    least = std::min(least, gap());
    if (w.world.time() > 2) slowest = std::min(slowest, w.speed(1));
    expectThatItCanStop();
  });
  EXPECT_LT(slowest, 0.15);
  EXPECT_GT(least, 0.25);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
  // They walk around it, and it drives on.
  w.runUntilIdle(1, 60, [&] { least = std::min(least, gap()); });
  EXPECT_GT(least, 0.1);
  EXPECT_NEAR(pose().X(), 1, 1e-6);
  w.expectAt(1, 12, 0);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
}

TEST_F(People, WhoStandBesideALaneAreNearForNoFastRobot) {
  w.world.setState("person1", {Pose(5, 1, 0, 0, 0, 0), {}});
  w.world.walk("person1", {});
  follow(10);
  double fastest = 0;
  w.runUntilIdle(1, 60, [&] {
    if (std::abs(ahead() - w.robot(1).half_length - 0.2) < 0.2)
      fastest = std::max(fastest, w.speed(1));
  });
  w.expectAt(1, 10, 0);
  EXPECT_GT(fastest, 0.1);
  EXPECT_LT(fastest, 0.6);
}

TEST_F(People, WalkAsFastAsTheyAreAskedAndStayWhereTheyArrive) {
  w.world.walk("person1", through({{5, -3.2}, {6.2, -3.2, 0.6, 1}, {5, -3.2}}));
  w.run(0.5);
  EXPECT_NEAR(pose().Y(), -3.8, 2e-3);
  EXPECT_NEAR(w.world.state("person1")->twist.linear.Y(), 1.2, 1e-9);
  EXPECT_NEAR(person().ahead_y, -3.2, 1e-9);  // no farther than the next corner
  w.run(2.5);
  EXPECT_NEAR(pose().X(), 6.2, 2e-3);
  EXPECT_NEAR(pose().Yaw(), 0, 1e-9);
  w.run(0.9);
  EXPECT_NEAR(pose().X(), 6.2, 2e-3);  // the pause
  w.run(5);
  EXPECT_NEAR(pose().X(), 5, 1e-9);
  EXPECT_EQ(w.world.state("person1")->twist.linear.Length(), 0);
  EXPECT_NEAR(w.world.rayCast({3, -3.2, 0.2}, 0, 5), 2 - kRadius, 0.01);
}

TEST_F(People, StopBeforeARobotThatStandsAndWalkAroundIt) {
  w.world.setState("person1", {Pose(-4, 0, 0, 0, 0, 0), {}});
  w.world.walk("person1", through({{4, 0}}));
  double least = 1e9;
  w.run(4, [&] { least = std::min(least, gap()); });
  EXPECT_LT(pose().X(), -0.7);
  EXPECT_EQ(w.world.state("person1")->twist.linear.Length(), 0);
  w.run(12, [&] { least = std::min(least, gap()); });
  EXPECT_NEAR(pose().X(), 4, 1e-6);
  EXPECT_NEAR(pose().Y(), 0, 1e-6);
  EXPECT_GT(least, 0.09);
  w.expectAt(1, 0, 0);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
}

TEST_F(People, StandBeforeWhatTheyCannotPass) {
  w.spawn("conveyor_belt", "conveyor_belt1", 5, 0);
  w.world.walk("person1", through({{5, 0}}));
  w.run(20);
  EXPECT_LT(pose().Y(), -0.3);
  EXPECT_GT(pose().Y(), -2);
  w.world.remove("conveyor_belt1");
  w.run(40);
  EXPECT_NEAR(pose().Y(), 0, 1e-6);
}

TEST_F(People, WithinReachOfItsCornersKeepARobotFromTurning) {
  w.world.setState("person1", {Pose(0, 0.65, 0, 0, 0, 0), {}});
  w.world.walk("person1", {});
  w.run(0.2);
  w.rot(1, kLeft);
  w.run(3);
  EXPECT_LT(std::abs(w.yaw(1)), 0.05);
  w.world.walk("person1", through({{0, 3}}));
  w.runUntilIdle(1);
  EXPECT_NEAR(w.yaw(1), kQuarter, kHundredthDegree);
  EXPECT_EQ(w.count(Kind::kCollision), 0);
}

TEST_F(People, InALightCurtainStopAllRobotsInside) {
  w.spawn("kiva", "kiva2", 0, 6);
  w.world.setLightCurtain({"pit", 1, 12, -7, 2});
  w.world.walk("person1", {});
  follow(10);
  w.movx(2, 10);
  w.run(6);
  EXPECT_EQ(w.speed(1), 0);
  EXPECT_GT(w.x(1), 0.5);
  EXPECT_LT(w.x(1), 1.2);  // as soon as it reached in
  EXPECT_EQ(w.world.fleet().curtained[0], 1);
  EXPECT_GT(w.x(2), 4);
  w.world.walk("person1", through({{16, -4.4}}));
  w.runUntilIdle(1);
  w.expectAt(1, 10, 0);
  EXPECT_GT(pose().X(), 12);
  w.world.walk("person1", through({{5, -4.4}}));
  w.run(12);
  EXPECT_EQ(w.world.fleet().curtained[0], 1);
  EXPECT_TRUE(w.world.removeLightCurtain("pit"));
  EXPECT_FALSE(w.world.removeLightCurtain("pit"));
  w.run(0.1);
  EXPECT_EQ(w.world.fleet().curtained[0], 0);
}

TEST_F(People, WhoAreTakenAwayLetRobotsGoOn) {
  w.world.setState("person1", {Pose(4, 0, 0, 0, 0, 0), {}});
  w.world.walk("person1", {});
  follow(10);
  w.run(8);
  EXPECT_EQ(w.speed(1), 0);
  w.world.remove("person1");
  w.runUntilIdle(1);
  w.expectAt(1, 10, 0);
  EXPECT_TRUE(w.world.people().empty());
}

TEST_F(People, AreRefusedWhatMakesNoSense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusalOf("missing", through({{1, 1}})), "there is no model 'missing'");
  EXPECT_EQ(refusalOf("kiva1", through({{1, 1}})), "kiva1: it is not a person");
  EXPECT_EQ(refusalOf("ground_plane", through({{1, 1}})), "ground_plane: it is not a person");
  EXPECT_EQ(refusalOf("person1", through({{1, 1}, {nan, 1}})),
            "person1: waypoint 1: it is not finite");
  EXPECT_EQ(refusalOf("person1", through({{1, 30}})),
            "person1: waypoint 0 at (1, 30) is not on the floor");
  for (const double speed : {0.0, -1.0, 1.7, nan}) {
    EXPECT_PRED2(contains, refusalOf("person1", through({{1, 1, speed}})),
                 "a speed above 0 and up to 1.6 m/s was expected");
  }
  EXPECT_PRED2(contains, refusalOf("person1", through({{1, 1, 1, -1}})), "a pause of 0 s or more");
  EXPECT_TRUE(w.world.people().empty());
  EXPECT_THROW(w.world.setLightCurtain({"", 0, 1, 0, 1}), std::invalid_argument);
  EXPECT_THROW(w.world.setLightCurtain({"c", 1, 0, 0, 1}), std::invalid_argument);
  EXPECT_THROW(w.world.setLightCurtain({"c", 0, 1, 0, nan}), std::invalid_argument);
  EXPECT_TRUE(w.world.lightCurtains().empty());
}

TEST_F(People, GoOnFromACheckpointBitByBit) {
  w.world.setLightCurtain({"pit", 8, 12, -2, 2});
  follow(12);
  w.world.walk("person1", {{{5, 4.4}, {10, 0, 0.9, 1}, {5, -4.4}}, true});
  for (int part = 0; part < 10; ++part) {
    const std::string saved = w.world.checkpoint();
    Warehouse other{Floorplan{40}};
    other.world.restore(saved);
    ASSERT_EQ(other.world.stateHash(), w.world.stateHash());
    ASSERT_EQ(other.world.lightCurtains().size(), 1u);
    w.run(1.003);
    other.run(1.003);
    ASSERT_EQ(other.world.stateHash(), w.world.stateHash()) << "after part " << part;
    ASSERT_EQ(other.world.checkpoint(), w.world.checkpoint());
  }
  EXPECT_NE(pose().Pos(), Vector3(5, -4.4, 0));
}

// --- actors, as Gazebo saves them

std::string actor(const std::string& script) {
  return "<actor name='walker'><pose>2 0 1 0 0 0</pose><skin><filename>walk.dae</filename>"
         "<scale>1</scale></skin><animation name='walking'><filename>walk.dae</filename><scale>1"
         "</scale><interpolate_x>1</interpolate_x></animation>" +
         script + "</actor>";
}

std::string waypoint(double time, const std::string& pose) {
  return "<waypoint><time>" + number(time) + "</time><pose>" + pose + "</pose></waypoint>";
}

std::string script(const std::string& waypoints, const std::string& loop = "1") {
  return "<script><loop>" + loop +
         "</loop><delay_start>1.5</delay_start><auto_start>1</auto_start>" +
         "<trajectory id='0' type='walking'>" + waypoints + "</trajectory></script>";
}

Vector3 placeOf(const Warehouse& w) { return w.world.state("walker")->pose.Pos(); }

TEST(Actors, WalkByTheirTrajectory) {
  Warehouse w(
      Floorplan{20, 1, 0.001,
                actor(script(waypoint(0, "2 2 1 0 0 0") + waypoint(4, "2 -2 1 0 0 -1.57") +
                             waypoint(6, "2 -2 1 0 0 1.57") + waypoint(11, "2 2 1 0 0 1.57")))});
  w.run(1.4);
  EXPECT_EQ(placeOf(w), Vector3(2, 2, 0));
  w.run(2.1);
  EXPECT_NEAR(placeOf(w).Y(), 0, 0.02);  // 1 m/s
  w.run(2.5);
  EXPECT_NEAR(placeOf(w).Y(), -2, 1e-9);  // a pause of two seconds
  w.run(4);
  EXPECT_NEAR(placeOf(w).Y(), 0, 0.02);  // 0.8 m/s
  w.run(6);
  EXPECT_NEAR(placeOf(w).Y(), 0, 0.02);  // after 1.5 s, once more
  EXPECT_LT(w.world.state("walker")->twist.linear.Y(), 0);
  w.world.reset(true);
  EXPECT_EQ(placeOf(w), Vector3(2, 2, 0));
  w.run(3.5);
  EXPECT_NEAR(placeOf(w).Y(), 0, 0.02);
}

TEST(Actors, WithoutAScriptStand) {
  Warehouse w(Floorplan{20, 1, 0.001, actor("")});
  w.run(3);
  EXPECT_EQ(placeOf(w), Vector3(2, 0, 0));
  EXPECT_EQ(w.world.people().at(0).name, "walker");
}

TEST(Actors, LoseWhatMakesNoSense) {
  const auto warningsOf = [](const std::string& waypoints, std::size_t* count) {
    std::vector<std::string> warnings;
    const WorldDescription world = parseWorld(worldText({20, 1, 0.001, actor(script(waypoints))}),
                                              modelPaths(), "w", &warnings);
    const auto is_actor = [](const ModelInstance& model) { return model.name == "walker"; };
    *count =
        std::find_if(world.models.begin(), world.models.end(), is_actor)->walk->waypoints.size();
    std::string all;
    for (const std::string& warning : warnings) all += warning + "\n";
    return all;
  };
  std::size_t count = 0;
  const std::string left_out = "this waypoint is left out: expected a <pose> of six numbers";
  EXPECT_PRED2(contains,
               warningsOf(waypoint(0, "0 0 0 0 0 0") + waypoint(3, "nan 0 0 0 0 0"), &count),
               left_out);
  EXPECT_EQ(count, 1u);
  EXPECT_PRED2(contains,
               warningsOf(waypoint(2, "0 0 0 0 0 0") + waypoint(2, "3 0 0 0 0 0") +
                              waypoint(5, "3 0 0 0 0 0"),
                          &count),
               left_out);
  EXPECT_EQ(count, 2u);
  EXPECT_PRED2(contains,
               warningsOf(waypoint(0, "0 0 0 0 0 0") + waypoint(1, "8 0 0 0 0 0"), &count),
               "people walk to this waypoint at 1.6 m/s");
  warningsOf("", &count);
  EXPECT_EQ(count, 0u);
}

TEST(LightCurtains, StandInWorldFiles) {
  const auto curtain = [](const std::string& corners) {
    return "<plugin name='pit' filename='libkiva_light_curtain.so'>" + corners + "</plugin>";
  };
  Warehouse w(Floorplan{20, 1, 0.001, curtain("<min>1 2</min><max>3 5</max>")});
  ASSERT_EQ(w.world.lightCurtains().size(), 1u);
  const LightCurtain& pit = w.world.lightCurtains()[0];
  EXPECT_EQ(pit.name, "pit");
  EXPECT_EQ(pit.max_y, 5);
  Warehouse wrong(Floorplan{20, 1, 0.001, curtain("<min>1 2</min>")});
  EXPECT_TRUE(wrong.world.lightCurtains().empty());
  const auto warnings = wrong.world.takeWarnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_PRED2(contains, warnings[0], "light curtain 'pit': min_x < max_x");
}

}  // namespace
}  // namespace kiva::test
