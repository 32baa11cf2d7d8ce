// SPDX-License-Identifier: Apache-2.0
//
// External inputs of clients: forces on links, changes of masses, gravity, step and lights; and the
// contents of contacts.
#include <stdexcept>

#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr double kGravity = 9.81;  // [m/s²]
constexpr double kForever = std::numeric_limits<double>::infinity();

/// A cube of 10 kg and half a metre.
std::string cube(bool gravity = true) {
  return std::string("<sdf version='1.9'><model name='m'><link name='body'><gravity>") +
         (gravity ? "true" : "false") +
         "</gravity><inertial><mass>10</mass><inertia><ixx>0.4</ixx><iyy>0.4</iyy><izz>0.4</izz>"
         "</inertia></inertial><collision name='skin'><geometry><box><size>.5 .5 .5</size></box>"
         "</geometry></collision></link></model></sdf>";
}

class ExternalInputs : public ::testing::Test {
 protected:
  Vector3 position(const std::string& name) { return w.world.state(name)->pose.Pos(); }
  Twist twist(const std::string& name) { return w.world.state(name)->twist; }
  bool push(const std::string& model, const std::string& link, const Vector3& force, double start,
            double end, const Vector3& torque = {}) {
    return w.world.apply(Wrench{model, link, force, torque, {start, end}});
  }

  Warehouse w;
};

// --- wrenches

TEST_F(ExternalInputs, AWrenchActsForItsTimeToTheStep) {
  w.spawnText(cube(false), "box", 0, 0, 0, 2);
  ASSERT_TRUE(push("box", "body", {10, 0, 0}, 0.1, 0.3, {0, 0, 0.4}));
  w.run(0.1);
  EXPECT_EQ(twist("box").linear.X(), 0);
  w.run(0.5);
  EXPECT_NEAR(twist("box").linear.X(), 0.2, 1e-4);
  EXPECT_NEAR(twist("box").angular.Z(), 0.2, 1e-4);
  EXPECT_TRUE(w.world.externalInputs().wrenches.empty());
}

TEST_F(ExternalInputs, AWrenchLastsUntilItIsCleared) {
  w.spawnText(cube(false), "box", 0, 0, 0, 2);
  push("box", "body", {10, 0, 0}, 0, kForever);
  w.run(0.5);
  w.world.clearWrenches("box", "body");
  w.run(0.5);
  EXPECT_NEAR(twist("box").linear.X(), 0.5, 1e-3);
}

TEST_F(ExternalInputs, AWrenchGoesWithItsModel) {
  w.spawnText(cube(false), "box", 0, 0, 0, 2);
  push("box", "body", {10, 0, 0}, 0, kForever);
  w.world.remove("box");
  w.spawnText(cube(false), "box", 1, 0, 0, 2);
  w.run(0.1);
  EXPECT_EQ(position("box").X(), 1);
}

TEST_F(ExternalInputs, WhatCanNotBePushedIsRefused) {
  w.spawn("wall", "wall1", 0, 0);
  w.spawnText(cube(), "box", 3, 0);
  EXPECT_FALSE(push("wall1", "body", {1, 0, 0}, 0, 1));
  EXPECT_FALSE(push("box", "nothing", {1, 0, 0}, 0, 1));
  EXPECT_FALSE(push("missing", "body", {1, 0, 0}, 0, 1));
}

TEST_F(ExternalInputs, ARobotGivesWayWhereItsWheelsSlip) {
  w.spawn("kiva", "kiva1", 0, 0);
  w.run(0.1);
  push("kiva1", "chassis", {100, 0, 0}, 0, 1);
  w.run(1);
  EXPECT_NEAR(w.x(1), 0, 0.01);  // its brakes hold that
  push("kiva1", "chassis", {0, 3000, 0}, 0, 1.5);
  w.run(1);
  EXPECT_GT(w.y(1), 0.1);
}

TEST_F(ExternalInputs, AStandingUnitCanBePushed) {
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  w.run(0.1);
  push("storage_unit1", w.world.description("storage_unit1")->links.front().name, {1500, 0, 0}, 0,
       0.4);
  w.run(2);
  EXPECT_GT(w.unitPose(1).X(), 0.05);
}

// --- masses

TEST_F(ExternalInputs, AnotherMassAnswersOtherwiseToAForce) {
  w.spawnText(cube(false), "box", 0, 0, 0, 2);
  Link link = w.world.description("box")->links.front();
  link.mass = 20;
  link.principal_moments = {1, 1, 1};
  w.world.setState("box", {Pose(0, 0, 2, 0, 0, 0), {{0, 1, 0}, {}}});
  ASSERT_TRUE(w.world.setLinkInertia("box", link));
  EXPECT_EQ(w.world.description("box")->links.front().mass, 20);
  EXPECT_EQ(twist("box").linear.Y(), 1);  // it goes on as it went
  push("box", "body", {10, 0, 0}, 0, 1);
  w.run(1);
  EXPECT_NEAR(twist("box").linear.X(), 0.5, 1e-3);
}

TEST_F(ExternalInputs, GravityCanBeSwitchedOffForOneLink) {
  w.spawnText(cube(), "box", 0, 0, 0, 2);
  Link link = w.world.description("box")->links.front();
  link.gravity = false;
  w.world.setLinkInertia("box", link);
  w.run(1);
  EXPECT_EQ(position("box").Z(), 2);
}

TEST_F(ExternalInputs, AHeavierRobotIsHeavier) {
  w.spawn("kiva", "kiva1", 0, 0);
  const double before = w.robot(1).mass;
  Link link = *w.world.description("kiva1")->findLink("chassis");
  link.mass += 100;
  w.world.setLinkInertia("kiva1", link);
  EXPECT_NEAR(w.robot(1).mass, before + 100, 1e-9);
  w.movx(1, 2);
  w.runUntilIdle(1);
  w.expectAt(1, 2, 0);
}

TEST_F(ExternalInputs, AHeavierUnitLoadsItsCarrier) {
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  w.carry(1, 1);
  w.runUntilIdle(1);
  Link link = w.world.description("storage_unit1")->links.front();
  link.mass += 50;
  w.world.setLinkInertia("storage_unit1", link);
  EXPECT_NEAR(w.robot(1).load_mass, w.unit(1).mass, 1e-9);
}

TEST_F(ExternalInputs, WhatNoBodyCouldBeIsRefused) {
  w.spawnText(cube(), "box", 0, 0);
  const Link good = w.world.description("box")->links.front();
  Link bad = good;
  bad.mass = -1;
  EXPECT_THROW(w.world.setLinkInertia("box", bad), std::invalid_argument);
  bad = good;
  bad.principal_moments = {1, 1, 5};
  EXPECT_THROW(w.world.setLinkInertia("box", bad), std::invalid_argument);
  bad = good;
  bad.mass = std::nan("");
  EXPECT_THROW(w.world.setLinkInertia("box", bad), std::invalid_argument);
  bad = good;
  bad.name = "nothing";
  EXPECT_FALSE(w.world.setLinkInertia("box", bad));
}

// --- gravity and time

TEST_F(ExternalInputs, GravityChangesForWhatSleepsToo) {
  w.spawnText(cube(), "box", 0, 0, 0, 0.25);
  w.run(5);
  w.world.setGravity({0, 0, 1});
  w.run(1);
  EXPECT_NEAR(position("box").Z(), 0.25 + 0.5, 0.01);
  w.spawnText(cube(), "late", 3, 0, 0, 1);
  w.run(1);
  EXPECT_NEAR(position("late").Z(), 1.5, 0.01);
  EXPECT_THROW(w.world.setGravity({0, std::nan(""), 0}), std::invalid_argument);
}

TEST_F(ExternalInputs, AnotherStepLeavesTimeWhereItIs) {
  w.run(0.5);
  w.world.setStepSize(0.004);
  EXPECT_DOUBLE_EQ(w.world.time(), 0.5);
  w.step();
  EXPECT_DOUBLE_EQ(w.world.time(), 0.504);
  w.world.reset(true);
  w.step();
  EXPECT_DOUBLE_EQ(w.world.time(), 0.004);
  for (double bad : {0.0, -1.0, 2.0, std::nan("")}) {
    EXPECT_THROW(w.world.setStepSize(bad), std::invalid_argument);
  }
}

TEST_F(ExternalInputs, RobotsDriveAsWellWithAnotherStep) {
  w.spawn("kiva", "kiva1", 0, 0);
  w.movx(1, 5);
  w.run(1);
  w.world.setStepSize(0.002);
  w.runUntilIdle(1);
  w.expectAt(1, 5, 0);
}

// --- lights

TEST_F(ExternalInputs, LightsOfAWorldAreKept) {
  Floorplan plan;
  plan.more =
      "<light name='lamp' type='point'><pose>1 2 3 0 0 0</pose><diffuse>1 .5 0 1</diffuse>"
      "<attenuation><range>10</range><linear>0.2</linear></attenuation></light>";
  Warehouse lit(plan);
  const Light& lamp = lit.world.externalInputs().lights.at("lamp");
  EXPECT_EQ(lamp.pose.Pos(), Vector3(1, 2, 3));
  EXPECT_NEAR(lamp.diffuse[1], 0.5, 1e-6);
  EXPECT_NEAR(lamp.attenuation_linear, 0.2, 1e-9);
  EXPECT_TRUE(lit.world.removeLight("lamp"));
  EXPECT_FALSE(lit.world.removeLight("lamp"));
}

TEST_F(ExternalInputs, ALightCanBeSpawnedAlone) {
  std::vector<Light> lights;
  const auto models = parseModels(
      "<sdf version='1.6'><light name='l' type='spot'><direction>0 0 -1</direction>"
      "</light></sdf>",
      modelPaths(), "test", nullptr, &lights);
  EXPECT_TRUE(models.empty());
  ASSERT_EQ(lights.size(), 1u);
  EXPECT_EQ(lights.front().kind, Light::Kind::kSpot);
}

// --- contacts

TEST_F(ExternalInputs, ContactsTellWhoPressesHowHard) {
  w.spawnText(cube(), "box", 0, 0, 0, 0.25);
  w.run(0.5);
  const auto contacts = w.world.contacts("box");
  ASSERT_FALSE(contacts.empty());
  double weight = 0;
  for (const ContactPoint& point : contacts) {
    EXPECT_EQ(point.collision1, "box::body::skin");
    EXPECT_EQ(point.collision2, "ground_plane::floor::floor");
    EXPECT_NEAR(point.normal.Z(), 1, 1e-6);
    EXPECT_NEAR(point.position.Z(), 0, 0.005);
    weight += point.force.Z();
  }
  EXPECT_NEAR(weight, 10 * kGravity, 1);
  EXPECT_TRUE(w.world.contacts("missing").empty());
}

TEST_F(ExternalInputs, ACollisionTellsHowItHappened) {
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawnText(cube(false), "box", 3, 0, 0, 0.26);
  w.world.setState("box", {Pose(3, 0, 0.26, 0, 0, 0), {{-2, 0, 0}, {}}});
  w.runUntil([&] { return w.count(Event::Kind::kCollision) > 0; }, 5);
  const Event event = w.last(Event::Kind::kCollision);
  EXPECT_EQ(event.model, "kiva1");
  EXPECT_EQ(event.other, "box");
  EXPECT_NEAR(event.impact.normal.X(), -1, 1e-3);  // from the box towards the robot
  EXPECT_NEAR(event.impact.point.X(), w.robot(1).half_length, 0.02);
  EXPECT_NEAR(event.impact.speed, 2, 0.01);
}

/// The impulse reported to the model that was hit, and the speed that the other lost until the end.
struct Hit {
  Impact impact;
  double lost;  // [m/s]
};

/// A cube that meets `kiva1`, along an axis (0 = x, 2 = z), coming from where that is larger.
Hit hit(Warehouse& w, int axis) {
  const auto speed = [&] { return -w.world.state("box")->twist.linear[axis]; };
  double before = 0;
  w.runUntil(
      [&] {
        before = std::max(before, speed());
        return w.count(Event::Kind::kCollision) > 0;
      },
      5);
  w.run(0.005);  // catches reports that come too early
  const double weight = axis == 2 ? kGravity * 0.005 : 0;
  return {w.last(Event::Kind::kCollision).impact, before - speed() + weight};
}

/// The impulse is m Δv, whatever the step of the first contact.
TEST_F(ExternalInputs, ACollisionsImpulseIsWhatStoppedTheBox) {
  for (double gap : {0.1, 0.1003, 0.1005, 0.1011, 0.1019}) {
    Warehouse warehouse;
    warehouse.spawn("kiva", "kiva1", 0, 0);
    const double x = warehouse.robot(1).half_length + 0.25 + gap;
    warehouse.spawnText(cube(false), "box", x, 0, 0, 0.26);
    warehouse.world.setState("box", {Pose(x, 0, 0.26, 0, 0, 0), {{-2, 0, 0}, {}}});
    const Hit slid = hit(warehouse, 0);
    EXPECT_NEAR(slid.impact.speed, 2, 0.01) << gap;
    EXPECT_NEAR(slid.impact.impulse, 10 * slid.lost, 0.05 * 10 * slid.lost) << gap;
    EXPECT_NEAR(slid.impact.impulse, 10 * 2, 2) << gap;
  }
}

/// The impulse is m Δv for a box that falls on the robot: Bullet finds several corners one after
/// another.
TEST_F(ExternalInputs, ACollisionsImpulseIsWhatCaughtTheBox) {
  for (double height : {0.05, 0.2, 0.5}) {
    Warehouse warehouse;
    warehouse.spawn("kiva", "kiva1", 0, 0);
    warehouse.spawnText(cube(true), "box", 0, 0, 0, warehouse.robot(1).height + 0.25 + height);
    const Hit fell = hit(warehouse, 2);
    const double speed = std::sqrt(2 * kGravity * height);
    EXPECT_NEAR(fell.impact.speed, speed, 0.05 * speed) << height;
    EXPECT_NEAR(fell.impact.impulse, 10 * fell.lost, 0.05 * 10 * fell.lost) << height;
  }
}

// --- checkpoints

TEST_F(ExternalInputs, ACheckpointHoldsAnImpactThatIsNotOver) {
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawnText(cube(false), "box", 1, 0, 0, 0.26);
  w.world.setState("box", {Pose(1, 0, 0.26, 0, 0, 0), {{-2, 0, 0}, {}}});
  std::string saved;
  w.runUntil(
      [&] {
        const bool is_over = w.count(Event::Kind::kCollision) > 0;
        if (!is_over) saved = w.world.checkpoint();
        return is_over;
      },
      1);
  const double impulse = w.last(Event::Kind::kCollision).impact.impulse;
  EXPECT_GT(impulse, 18);
  w.forget();
  w.world.restore(saved);
  w.step();
  ASSERT_EQ(w.count(Event::Kind::kCollision), 1);
  EXPECT_EQ(w.last(Event::Kind::kCollision).impact.impulse, impulse);
}

TEST_F(ExternalInputs, ACheckpointHoldsWhatIsUnderWay) {
  const std::string door = replaced(
      cube(false), "</link>",
      "</link><link name='leaf'><pose>1 0 0 0 0 0</pose><gravity>false</gravity></link><joint "
      "name='hinge' type='revolute'><parent>body</parent><child>leaf</child><axis><xyz>0 0 1</xyz>"
      "</axis></joint>");
  w.spawnText(door, "door", 0, 0, 0, 2);
  w.world.setStepSize(0.002);
  push("door", "body", {3, 0, 0}, 0.2, 0.5);
  w.world.apply(Effort{"door", "hinge", 0.5, {0, kForever}});
  JointSettings settings = w.world.joint("door", "hinge")->settings;
  settings.damping = 0.1;
  w.world.setJoint("door", "hinge", settings);
  w.run(0.3);
  const std::string saved = w.world.checkpoint();
  const double time = w.world.time();
  w.run(1);
  const std::uint64_t hash = w.world.stateHash();
  const Pose pose = w.world.state("door", "leaf")->pose;
  w.world.restore(saved);
  EXPECT_DOUBLE_EQ(w.world.time(), time);
  EXPECT_EQ(w.world.joint("door", "hinge")->settings.damping, 0.1);
  w.run(1);
  EXPECT_EQ(w.world.state("door", "leaf")->pose, pose);
  EXPECT_EQ(w.world.stateHash(), hash);
}

}  // namespace
}  // namespace kiva::test
