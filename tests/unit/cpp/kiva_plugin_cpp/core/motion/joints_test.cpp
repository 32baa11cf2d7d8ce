// SPDX-License-Identifier: Apache-2.0
//
// Joints of ordinary models: reading, motors and efforts, damping, and setting positions.
#include <stdexcept>

#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kInertia = 0.5;  // of the wheel about its axle [kg m²]

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& axis, const std::string& more = "",
                  const std::string& pose = "0 0 0 0 0 0") {
  return "<joint name='" + name + "' type='" + type + "'><pose>" + pose + "</pose><parent>" +
         parent + "</parent><child>" + child + "</child><axis><xyz>" + axis + "</xyz>" + more +
         "</axis></joint>";
}

std::string body(const std::string& name, const std::string& pose = "0 0 0 0 0 0") {
  return "<link name='" + name + "'><pose>" + pose +
         "</pose><gravity>false</gravity><inertial><mass>2</mass><inertia><ixx>0.5</ixx><iyy>0.5"
         "</iyy><izz>0.5</izz></inertia></inertial></link>";
}

std::string model(const std::string& content) {
  return "<sdf version='1.9'><model name='m'>" + content + "</model></sdf>";
}

/// A wheel that turns about an axle along y, weightless.
std::string wheel(const std::string& more = "") {
  return model(body("wheel") + joint("axle", "continuous", "world", "wheel", "0 1 0", more));
}

std::string slide(const std::string& more = "") {
  return model(body("sledge") + joint("rail", "prismatic", "world", "sledge", "1 0 0", more));
}

/// Three links in a row along x, hinged about y where they meet.
std::string chain() {
  return model(body("a") + body("b", "1 0 0 0 0 0") + body("c", "2 0 0 0 0 0") +
               joint("ab", "revolute", "a", "b", "0 1 0", "", "-0.5 0 0 0 0 0") +
               joint("bc", "revolute", "b", "c", "0 1 0", "", "-0.5 0 0 0 0 0"));
}

class Joints : public ::testing::Test {
 protected:
  void spawn(const std::string& text) { w.spawnText(text, "m", 1, 2, 0, 3); }
  JointState state(const std::string& name) { return *w.world.joint("m", name); }
  void set(const std::string& name, const std::function<void(JointSettings&)>& change) {
    JointSettings settings = state(name).settings;
    change(settings);
    ASSERT_TRUE(w.world.setJoint("m", name, settings));
  }
  void push(const std::string& name, double effort, double start, double end) {
    ASSERT_TRUE(w.world.apply(Effort{"m", name, effort, {start, end}}));
  }
  Pose pose(const std::string& link) { return w.world.state("m", link)->pose; }

  Warehouse w;
};

// --- reading

TEST_F(Joints, AHingesPositionIsItsChildsTurnAboutTheAxis) {
  spawn(wheel());
  w.world.setJointPositions("m", {{"axle", 0.4}});
  EXPECT_NEAR(pose("wheel").Rot().Euler().Y(), 0.4, 1e-9);
  EXPECT_NEAR(state("axle").position, 0.4, 1e-12);
  push("axle", 1, 0, 1);
  w.run(0.5);
  EXPECT_GT(state("axle").rate, 0);
  EXPECT_GT(w.world.state("m", "wheel")->twist.angular.Y(), 0);
}

TEST_F(Joints, AHingeCountsItsTurns) {
  spawn(wheel());
  push("axle", kInertia * 10, 0, 1);  // 10 rad/s²
  w.run(3);
  EXPECT_NEAR(state("axle").rate, 10, 0.02);
  EXPECT_NEAR(state("axle").position, 5 + 20, 0.05);
}

TEST_F(Joints, ASlidersPositionIsItsWay) {
  spawn(slide());
  push("rail", 4, 0, 1);  // 2 m/s²
  w.run(2);
  EXPECT_NEAR(state("rail").rate, 2, 0.01);
  EXPECT_NEAR(state("rail").position, 3, 0.01);
  EXPECT_NEAR(pose("sledge").X(), 1 + 3, 0.01);
}

TEST_F(Joints, WhatIsNotThereIsNotRead) {
  spawn(wheel());
  EXPECT_FALSE(w.world.joint("m", "nothing"));
  EXPECT_FALSE(w.world.joint("nothing", "axle"));
  EXPECT_FALSE(w.world.setJoint("m", "nothing", {}));
  EXPECT_FALSE(w.world.apply(Effort{"m", "nothing", 1, {0, 1}}));
}

TEST_F(Joints, ARobotsWheelsAndTowerAreRead) {
  w.spawn("kiva", "kiva1", 0, 0);
  w.movx(1, 2);
  w.run(1);
  EXPECT_GT(w.world.joint("kiva1", "left_wheel_joint")->rate, 1);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.world.joint("kiva1", "left_wheel_joint")->position,
              2 / w.robot(1).drive.wheel_radius, 0.2);
  EXPECT_EQ(w.world.joint("kiva1", "tower_joint")->position, 0);
  EXPECT_FALSE(w.world.apply(Effort{"kiva1", "left_wheel_joint", 1, {0, 1}}));
  EXPECT_THROW(w.world.setJoint("kiva1", "left_wheel_joint", {}), std::invalid_argument);
}

// --- balls

/// 1 m below the ball that it hangs on.
std::string pendulum() {
  const std::string bob = replaced(body("bob", "0 0 -1 0 0 0"), "<gravity>false</gravity>", "");
  return model(bob +
               "<joint name='ball' type='ball'><pose relative_to='__model__'>0 0 0 0 0 0</pose>"
               "<parent>world</parent><child>bob</child></joint>");
}

/// Period of small swings: 2π √(I / m g l), I about the ball (Huygens, Steiner).
TEST_F(Joints, ABallSwingsInBothDirectionsAndTurns) {
  spawn(pendulum());
  const double period = 2 * M_PI * std::sqrt((kInertia + 2 * 1) / (2 * 9.81 * 1));
  const Vector3 swing(0.1, 0.2, 0), turn(0.2, -0.1, 0.1);
  ASSERT_TRUE(w.world.setLinkState("m", "bob", {pose("bob"), {swing, turn}}));
  for (int eighth = 0; eighth < 8; ++eighth) {
    w.run(period / 8);
    EXPECT_NEAR((pose("bob").Pos() - Vector3(1, 2, 3)).Length(), 1, 1e-3);
  }
  EXPECT_LT((pose("bob").Pos() - Vector3(1, 2, 2)).Length(), 0.002);
  EXPECT_LT((w.world.state("m", "bob")->twist.linear - swing).Length(), 0.01);
  EXPECT_NEAR(w.world.state("m", "bob")->twist.angular.Z(), 0.1, 0.002);
}

TEST_F(Joints, ABallSwingsOnFromACheckpoint) {
  spawn(pendulum());
  ASSERT_TRUE(w.world.setLinkState("m", "bob", {pose("bob"), {{0.5, 0.2, 0}, {0.2, -0.5, 0}}}));
  w.run(0.3);
  const std::string saved = w.world.checkpoint();
  w.run(0.5);
  const auto hash = w.world.stateHash();
  w.world.restore(saved);
  w.run(0.5);
  EXPECT_EQ(w.world.stateHash(), hash);
  EXPECT_NEAR((pose("bob").Pos() - Vector3(1, 2, 3)).Length(), 1, 1e-3);
}

TEST_F(Joints, ABallHasNoPositionToBePut) {
  spawn(pendulum());
  EXPECT_THROW(w.world.setJointPositions("m", {{"ball", 1}}), std::invalid_argument);
  EXPECT_THROW(w.world.setJoint("m", "ball", {}), std::invalid_argument);
  EXPECT_TRUE(w.world.apply(Effort{"m", "ball", 1, {0, 1}}));
  w.run(0.1);
  EXPECT_EQ(state("ball").position, 0);
}

// --- motors, damping, friction

TEST_F(Joints, AMotorHoldsItsSpeed) {
  spawn(wheel());
  set("axle", [](JointSettings& s) { s.motor_speed = 3, s.motor_effort = 1000; });
  w.run(1);
  EXPECT_NEAR(state("axle").rate, 3, 0.01);
  EXPECT_NEAR(state("axle").position, 3, 0.01);
  set("axle", [](JointSettings& s) { s.motor_speed = 0; });
  w.run(1);
  EXPECT_NEAR(state("axle").rate, 0, 0.001);
}

TEST_F(Joints, AMotorUsesNoMoreThanItMay) {
  spawn(wheel());
  set("axle", [](JointSettings& s) { s.motor_speed = 100, s.motor_effort = 2; });
  w.run(1);
  EXPECT_NEAR(state("axle").rate, 2 / kInertia, 0.05);
}

TEST_F(Joints, ASlidersMotorGoesTheSameWay) {
  spawn(slide());
  set("rail", [](JointSettings& s) { s.motor_speed = 0.5, s.motor_effort = 1000; });
  w.run(1);
  EXPECT_NEAR(state("rail").position, 0.5, 0.01);
  w.world.reset(true);
  set("rail", [](JointSettings& s) { s.motor_speed = 5, s.motor_effort = 2; });
  w.run(1);
  EXPECT_NEAR(state("rail").rate, 1, 0.02);  // 2 N on 2 kg
}

TEST_F(Joints, DampingMakesATerminalSpeed) {
  spawn(wheel("<dynamics><damping>2</damping></dynamics>"));
  push("axle", 1, 0, kForever);
  w.run(3);
  EXPECT_NEAR(state("axle").rate, 0.5, 0.005);
}

TEST_F(Joints, StrongDampingStopsAndNeverThrows) {
  spawn(wheel("<dynamics><damping>1000000</damping></dynamics>"));
  push("axle", 100, 0, kForever);
  w.run(1, [&] { ASSERT_LT(std::abs(state("axle").rate), 0.5); });
}

TEST_F(Joints, FrictionHoldsUntilItIsOvercome) {
  spawn(wheel("<dynamics><friction>1</friction></dynamics>"));
  push("axle", 0.9, 0, 1);
  w.run(1);
  EXPECT_NEAR(state("axle").rate, 0, 1e-3);
  push("axle", 2, 1, 2);
  w.run(1);
  EXPECT_NEAR(state("axle").rate, (2 - 1) / kInertia, 0.05);
}

TEST_F(Joints, LimitsCanBeSet) {
  spawn(wheel());
  set("axle", [](JointSettings& s) { s.lower = -0.2, s.upper = 0.3; });
  push("axle", 1, 0, kForever);
  w.run(3);
  EXPECT_NEAR(state("axle").position, 0.3, 0.01);
}

TEST_F(Joints, AnEffortIsLimitedByItsJoint) {
  spawn(wheel("<limit><effort>1</effort></limit>"));
  push("axle", 100, 0, 1);
  w.run(1);
  EXPECT_NEAR(state("axle").rate, 1 / kInertia, 0.05);
}

TEST_F(Joints, SettingsOutOfRangeAreRefused) {
  spawn(wheel());
  for (double bad : {-1.0, std::nan(""), kForever}) {
    EXPECT_THROW(w.world.setJoint("m", "axle", {bad, 0, -1, 1, 0, 0}), std::invalid_argument);
    EXPECT_THROW(w.world.setJoint("m", "axle", {0, 0, -1, 1, 0, bad}), std::invalid_argument);
  }
  EXPECT_THROW(w.world.setJoint("m", "axle", {0, 0, 1, -1, 0, 0}), std::invalid_argument);
  EXPECT_THROW(w.world.setJoint("m", "axle", {0, 0, -1, 1, std::nan(""), 1}),
               std::invalid_argument);
}

// --- when efforts act

TEST_F(Joints, AnEffortActsForItsTimeToTheStep) {
  spawn(wheel());
  push("axle", kInertia, 0.1, 0.2);
  w.run(0.1);
  EXPECT_EQ(state("axle").rate, 0);
  w.run(0.3);
  EXPECT_NEAR(state("axle").rate, 0.1, 1e-4);
  EXPECT_TRUE(w.world.externalInputs().efforts.empty());
}

TEST_F(Joints, AnEffortEndsWhenItIsClearedOrItsModelGoes) {
  spawn(wheel());
  push("axle", 1, 0, kForever);
  w.world.clearEfforts("m", "axle");
  w.run(0.1);
  EXPECT_EQ(state("axle").rate, 0);
  push("axle", 1, 0, kForever);
  w.world.remove("m");
  spawn(wheel());
  w.run(0.1);
  EXPECT_EQ(state("axle").rate, 0);
}

TEST_F(Joints, AResetEndsEffortsAndMotors) {
  spawn(wheel());
  push("axle", 1, 0, kForever);
  set("axle", [](JointSettings& s) { s.motor_speed = 3, s.motor_effort = 100; });
  w.run(0.1);
  w.world.reset(true);
  w.run(0.1);
  EXPECT_EQ(state("axle").position, 0);
  EXPECT_EQ(state("axle").rate, 0);
}

TEST_F(Joints, WhatSleepsIsWokenByItsMotor) {
  spawn(wheel());
  w.run(5);
  set("axle", [](JointSettings& s) { s.motor_speed = 3, s.motor_effort = 100; });
  w.run(5);
  EXPECT_NEAR(state("axle").rate, 3, 0.01);
}

// --- putting joints somewhere

TEST_F(Joints, WhatHangsOnAJointGoesWithIt) {
  spawn(chain());
  w.world.setJointPositions("m", {{"ab", -M_PI / 2}});
  EXPECT_LT((pose("a").Pos() - Vector3(1, 2, 3)).Length(), 1e-9);
  EXPECT_LT((pose("b").Pos() - Vector3(1.5, 2, 3.5)).Length(), 1e-9);
  EXPECT_LT((pose("c").Pos() - Vector3(1.5, 2, 4.5)).Length(), 1e-9);
  w.world.setJointPositions("m", {{"bc", M_PI / 2}});
  EXPECT_LT((pose("c").Pos() - Vector3(2, 2, 4)).Length(), 1e-9);
  w.run(0.5);
  EXPECT_NEAR(state("ab").position, -M_PI / 2, 1e-3);
  EXPECT_NEAR(state("bc").position, M_PI / 2, 1e-3);
}

TEST_F(Joints, AllArePutOrNone) {
  spawn(chain());
  for (const auto& bad :
       std::vector<std::pair<std::string, double>>{{"nothing", 0}, {"bc", std::nan("")}}) {
    EXPECT_THROW(w.world.setJointPositions("m", {{"ab", 1}, {bad.first, bad.second}}),
                 std::invalid_argument);
    EXPECT_EQ(state("ab").position, 0);
  }
  EXPECT_THROW(w.world.setJointPositions("missing", {}), std::invalid_argument);
}

TEST_F(Joints, AJointInALoopCanNotBePut) {
  const std::string loop = joint("ca", "revolute", "c", "a", "0 1 0");
  spawn(replaced(chain(), "</model>", loop + "</model>"));
  EXPECT_THROW(w.world.setJointPositions("m", {{"ab", 1}}), std::invalid_argument);
}

TEST_F(Joints, ALinkThatIsPutTakesWhatIsJointedToIt) {
  spawn(chain());
  const Vector3 speed(0, 0, 0.1);
  ASSERT_TRUE(w.world.setLinkState("m", "b", {Pose(5, 5, 5, 0, 0, M_PI / 2), {speed, {}}}));
  EXPECT_LT((pose("b").Pos() - Vector3(5, 5, 5)).Length(), 1e-9);
  EXPECT_LT((pose("c").Pos() - Vector3(5, 6, 5)).Length(), 1e-9);
  EXPECT_LT((pose("a").Pos() - Vector3(5, 4, 5)).Length(), 1e-9);
  EXPECT_EQ(w.world.state("m", "b")->twist.linear, speed);
  EXPECT_FALSE(w.world.setLinkState("m", "nothing", {}));
}

}  // namespace
}  // namespace kiva::test
