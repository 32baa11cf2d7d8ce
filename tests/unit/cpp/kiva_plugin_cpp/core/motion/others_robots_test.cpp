// SPDX-License-Identifier: Apache-2.0
//
// Robots of other makers: with casters that swivel, bogies, sprung wheels and lifts, whose parts
// overlap as those of drawings do. They stand, and drive as far as their wheels turn.
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr double kRadius = 0.1;       // of driven wheels [m]
constexpr double kEffort = 30;        // of their motors [Nm]
constexpr double kChassis = 60;       // [kg]
constexpr double kStiffness = 10000;  // of a strut's spring [N/m]

std::string inertial(double mass, double moment, const std::string& at = "0 0 0") {
  const std::string i = number(moment);
  return "<inertial><origin xyz='" + at + "'/><mass value='" + number(mass) + "'/><inertia ixx='" +
         i + "' iyy='" + i + "' izz='" + i + "' ixy='0' ixz='0' iyz='0'/></inertial>";
}

std::string box(const std::string& size, const std::string& at = "0 0 0") {
  return "<collision><origin xyz='" + at + "'/><geometry><box size='" + size +
         "'/></geometry></collision>";
}

std::string link(const std::string& name, const std::string& content) {
  return "<link name='" + name + "'>" + content + "</link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& at, const std::string& axis, const std::string& more = "") {
  return "<joint name='" + name + "_joint' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + name + "'/><origin xyz='" + at + "'/><axis xyz='" + axis + "'/>" +
         more + "</joint>";
}

std::string tyre(double radius, double width) {
  return "<collision><origin rpy='1.5707963 0 0'/><geometry><cylinder radius='" + number(radius) +
         "' length='" + number(width) + "'/></geometry></collision>";
}

std::string wheel(const std::string& name, const std::string& parent, const std::string& at,
                  double radius = kRadius) {
  return link(name, inertial(1, 0.005) + tyre(radius, 0.04)) +
         joint(name, "continuous", parent, at, "0 1 0");
}

/// A wheel behind the axis that it swivels about, within the hull of the chassis.
std::string caster(const std::string& name, const std::string& at) {
  return link(name, inertial(0.3, 0.0005, "0 0 -0.04") + box("0.08 0.06 0.08", "0 0 -0.03")) +
         joint(name, "continuous", "base", at, "0 0 1", "<dynamics damping='0.01'/>") +
         wheel(name + "_wheel", name, "-0.04 0 -0.09", 0.06);
}

std::string base(const std::string& more = "") {
  return link("base", inertial(kChassis, 3) + box("0.8 0.5 0.2", "0 0 0.06") + more);
}

std::string robot(const std::string& content) { return "<robot name='r'>" + content + "</robot>"; }

/// Two driven wheels in the middle, a caster at each corner: the base's origin is 0.1 m up.
std::string withCasters() {
  return robot(base() + wheel("left", "base", "0 0.22 0") + wheel("right", "base", "0 -0.22 0") +
               caster("fl", "0.34 0.2 0.05") + caster("fr", "0.34 -0.2 0.05") +
               caster("bl", "-0.3 0.2 0.05") + caster("br", "-0.3 -0.2 0.05"));
}

/// Four driven wheels, two on each of two rockers beside the chassis.
std::string withBogies() {
  std::string parts = base();
  for (const auto& [side, y] : {std::pair{std::string("left"), "0.27"}, {"right", "-0.27"}}) {
    parts += link(side + "_rocker", inertial(2, 0.02) + box("0.5 0.04 0.06")) +
             joint(side + "_rocker", "revolute", "base", std::string("0 ") + y + " 0.02", "0 1 0",
                   "<limit lower='-0.3' upper='0.3' effort='0' velocity='1'/>") +
             wheel(side, side + "_rocker", "0.2 0 -0.02") +
             wheel(side + "_rear", side + "_rocker", "-0.2 0 -0.02");
  }
  return robot(parts);
}

/// Four driven wheels, each on a strut that slides up and down against a spring.
std::string withSprungWheels() {
  std::string parts = base();
  for (const auto& [name, at] : {std::pair{std::string("left"), "0.25 0.3 0"},
                                 {"left_rear", "-0.25 0.3 0"},
                                 {"right", "0.25 -0.3 0"},
                                 {"right_rear", "-0.25 -0.3 0"}}) {
    const std::string strut = name + "_strut";
    parts += link(strut, inertial(0.5, 0.001)) +
             joint(strut, "prismatic", "base", at, "0 0 1",
                   "<limit lower='-0.05' upper='0.05' effort='0' velocity='1'/>"
                   "<dynamics damping='300'/>") +
             "<gazebo reference='" + strut + "_joint'><springStiffness>" + number(kStiffness) +
             "</springStiffness></gazebo>" + wheel(name, strut, "0 0 0");
  }
  return robot(parts);
}

/// A plate on the robot with casters that slides up, and down between its wheels.
std::string withLift(const std::string& limit) {
  return replaced(withCasters(), "</robot>",
                  link("lift", inertial(5, 0.1) + box("0.7 0.46 0.1")) +
                      joint("lift", "prismatic", "base", "0 0 0.1", "0 0 1", limit) + "</robot>");
}

class OthersRobots : public ::testing::Test {
 protected:
  void spawn(const std::string& text, std::vector<std::string> left = {"left_joint"},
             std::vector<std::string> right = {"right_joint"}) {
    left_ = std::move(left);
    right_ = std::move(right);
    w.spawnText(text, "r", 0, 0, 0, kRadius + 0.002);
    turn(0);
  }
  /// Sets the motors of all driven wheels to a speed of their rims [m/s].
  void turn(double speed) {
    for (const auto* side : {&left_, &right_}) {
      for (const std::string& name : *side) {
        JointSettings settings = w.world.joint("r", name)->settings;
        settings.motor_speed = speed / kRadius;
        settings.motor_effort = kEffort;
        w.world.setJoint("r", name, settings);
      }
    }
  }
  Vector3 place() { return w.world.state("r")->pose.Pos(); }
  double position(const std::string& joint) { return w.world.joint("r", joint)->position; }

  /// A motor that is set in each step keeps the robot awake.
  void expectToStand() {
    w.run(1);
    const Vector3 before = place();
    w.run(3, [&] { turn(0); });
    EXPECT_LT((place() - before).Length(), kMillimetre / 10) << "awake";
    w.run(57);
    EXPECT_LT((place() - before).Length(), kMillimetre) << "in a minute";
  }
  void expectToDrive(double distance) {
    const Vector3 before = place();
    constexpr double kSpeed = 0.4, kAcceleration = 0.8;
    double speed = 0, commanded = 0;
    w.run(distance / kSpeed + kSpeed / kAcceleration + 1, [&] {
      const double left = distance - commanded, dt = w.world.stepSize();
      const double brakes = std::sqrt(std::max(0.0, 2 * kAcceleration * left));
      speed = std::min({speed + kAcceleration * dt, kSpeed, brakes});
      commanded += speed * dt;
      turn(speed);
    });
    EXPECT_NEAR((place() - before).X(), distance, 0.02 * distance);
    EXPECT_NEAR((place() - before).Y(), 0, 0.02 * distance);
  }

  Warehouse w;

 private:
  std::vector<std::string> left_, right_;
};

TEST_F(OthersRobots, CastersThatSwivelWithinTheChassisLetItStandAndDrive) {
  spawn(withCasters());
  expectToStand();
  expectToDrive(2);
}

TEST_F(OthersRobots, BogiesLetItStandAndDrive) {
  spawn(withBogies(), {"left_joint", "left_rear_joint"}, {"right_joint", "right_rear_joint"});
  expectToStand();
  expectToDrive(2);
}

TEST_F(OthersRobots, SprungWheelsLetItStandAndDrive) {
  spawn(withSprungWheels(), {"left_joint", "left_rear_joint"}, {"right_joint", "right_rear_joint"});
  expectToStand();
  EXPECT_NEAR(position("left_strut_joint"), kChassis * 9.81 / (4 * kStiffness), kMillimetre / 10);
  expectToDrive(2);
}

TEST_F(OthersRobots, ASpringCarriesItsLoadWhereForcesAreEven) {
  const std::string bob = "<robot name='r'><link name='world'/>" + link("bob", inertial(2, 0.01)) +
                          joint("bob", "prismatic", "world", "0 0 1", "0 0 1",
                                "<limit lower='-1' upper='1' effort='0' velocity='9'/>"
                                "<dynamics damping='20'/>") +
                          "<gazebo reference='bob_joint'><springStiffness>400</springStiffness>"
                          "<springReference value='0.1'/></gazebo></robot>";
  w.spawnText(bob, "r", 0, 0);
  w.run(3);
  EXPECT_NEAR(position("bob_joint"), 0.1 - 2 * 9.81 / 400, 1e-4);
}

/// A plate in the air, and above it a bob that slides down, both on rails of their own.
std::string bobAbovePlate(const std::string& extension) {
  return "<robot name='r'><link name='world'/>" +
         link("plate", inertial(1, 0.1) + box("0.4 0.4 0.1")) +
         joint("plate", "fixed", "world", "0 0 0.5", "0 0 1") +
         link("bob", inertial(1, 0.1) + box("0.1 0.1 0.1")) +
         joint("bob", "prismatic", "world", "0 0 1", "0 0 1",
               "<limit lower='-2' upper='2' effort='0' velocity='9'/>") +
         extension + "</robot>";
}

TEST_F(OthersRobots, LinksOfAModelTouchEachOtherWhereItSaysSo) {
  w.spawnText(bobAbovePlate(""), "through", 0, 0);
  w.spawnText(bobAbovePlate("<gazebo reference='bob'><selfCollide value='true'/></gazebo>"), "onto",
              2, 0);
  w.run(1.5);
  EXPECT_NEAR(w.world.state("through", "bob")->pose.Z(), 0.05, kMillimetre) << "on the floor";
  EXPECT_NEAR(w.world.state("onto", "bob")->pose.Z(), 0.6, kMillimetre) << "on the plate";
}

TEST_F(OthersRobots, FrictionIsReadFromAnAttributeOrAText) {
  for (const std::string mu : {"<mu1 value='0.3'/><mu2 value='0.3'/>", "<mu1>0.3</mu1>"}) {
    const std::string text =
        replaced(withCasters(), "</robot>", "<gazebo reference='left'>" + mu + "</gazebo></robot>");
    const auto description = instance(text, "r").description;
    EXPECT_EQ(description->findLink("left")->collisions.at(0).friction, 0.3) << mu;
    EXPECT_EQ(description->findLink("right")->collisions.at(0).friction, 1) << mu;
  }
}

TEST_F(OthersRobots, ALiftWithoutEffortRestsAtItsLowerLimit) {
  spawn(withLift("<limit lower='0' upper='0.4' effort='0' velocity='0.1'/>"));
  expectToStand();
  EXPECT_NEAR(position("lift_joint"), 0, kMillimetre);
  expectToDrive(2);
  EXPECT_NEAR(position("lift_joint"), 0, kMillimetre);
}

TEST_F(OthersRobots, ALiftWithoutLimitsStaysWhereItIs) {
  spawn(withLift(""));
  expectToStand();
  EXPECT_NEAR(position("lift_joint"), 0, kMillimetre);
}

}  // namespace
}  // namespace kiva::test
