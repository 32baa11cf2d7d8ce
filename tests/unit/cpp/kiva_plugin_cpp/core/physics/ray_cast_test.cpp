// SPDX-License-Identifier: Apache-2.0
//
// Rays in any direction, wrenches of joints on their links, and velocities of models: the basis of
// sensors and drives that were written for Gazebo.
#include <chrono>
#include <cmath>

#include "warehouse.h"

namespace kiva::test {
namespace {

std::string shape(const std::string& geometry, const std::string& pose, bool is_static) {
  return "<sdf version='1.9'><model name='m'><static>" + std::string(is_static ? "true" : "false") +
         "</static><link name='l'><collision name='c'><pose>" + pose + "</pose><geometry>" +
         geometry + "</geometry></collision></link></model></sdf>";
}

double cast(const World& world, const Vector3& from, const Vector3& way, double range = 20,
            const std::string& but = "") {
  std::vector<double> out;
  world.rayCast(from, {way.Normalized()}, range, but, &out);
  return out.at(0);
}

TEST(RayCast, MeetsShapesWhereTheyAre) {
  const struct {
    const char* geometry;
    Vector3 from, way;
    double expected;
  } cases[] = {
      {"<box><size>1 2 3</size></box>", {5, 0, 1.5}, {-1, 0, 0}, 4.5},
      {"<box><size>1 2 3</size></box>", {0, 0, 9}, {0, 0, -1}, 6},
      {"<sphere><radius>1</radius></sphere>", {0, 0, 9}, {0, 0, -1}, 6.5},
      {"<cylinder><radius>1</radius><length>2</length></cylinder>", {0, 0.5, 9}, {0, 0, -1}, 6.5},
      {"<capsule><radius>1</radius><length>2</length></capsule>", {0, 0, 9}, {0, 0, -1}, 5.5},
      {"<ellipsoid><radii>1 1 0.5</radii></ellipsoid>", {0, 0, 9}, {0, 0, -1}, 7},
  };
  for (const auto& c : cases) {
    for (bool is_static : {true, false}) {
      Warehouse w;
      w.spawnText(shape(c.geometry, "0 0 1.5 0 0 0", is_static), "m", 0, 0);
      EXPECT_NEAR(cast(w.world, c.from, c.way), c.expected, 1e-6) << c.geometry << is_static;
      EXPECT_EQ(cast(w.world, c.from, c.way, 3), std::numeric_limits<double>::infinity());
    }
  }
}

TEST(RayCast, MeetsTheFloorAndPassesItsOwnModel) {
  Warehouse w;
  w.spawnText(shape("<box><size>1 1 1</size></box>", "0 0 0.5 0 0 0", true), "m", 0, 0);
  EXPECT_NEAR(cast(w.world, {0, 0, 5}, {0, 0, -1}), 4, 1e-6);
  EXPECT_NEAR(cast(w.world, {0, 0, 5}, {0, 0, -1}, 20, "m"), 5, 1e-6);
  EXPECT_NEAR(cast(w.world, {-5, 0, 1}, {1, 0, -0.25}), std::hypot(4.0, 1.0), 1e-6);
}

TEST(RayCast, AgreesWithLevelRaysAmongManyModels) {
  Warehouse w;
  for (int i = 0; i < 40; ++i) {
    const std::string name = "m" + std::to_string(i);
    w.spawnText(shape("<box><size>0.3 0.2 1</size></box>", "0 0 0.5 0 0 0", i % 2 == 0), name,
                3 + i % 7, -3 + i / 7, 0.3 * i);
  }
  for (int ray = 0; ray < 360; ++ray) {
    const double yaw = ray * M_PI / 180;
    const double met = cast(w.world, {0, 0, 0.4}, {std::cos(yaw), std::sin(yaw), 0});
    const double level = w.world.rayCast({0, 0, 0.4}, yaw, 20);
    EXPECT_EQ(std::isfinite(met), std::isfinite(level)) << ray;
    if (std::isfinite(level)) {
      EXPECT_NEAR(met, level, 1e-6) << ray;
    }
  }
}

TEST(RayCast, CostsAboutAMicrosecondARay) {
  Warehouse w("paper.sdf");
  std::vector<Vector3> ways;
  for (int i = 0; i < 100000; ++i) {
    const double yaw = i * 0.0001, pitch = 0.3 * std::sin(i * 0.01);
    ways.emplace_back(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                      std::sin(pitch));
  }
  std::vector<double> out;
  const auto start = std::chrono::steady_clock::now();
  w.world.rayCast({0, 0, 0.5}, ways, 30, "", &out);
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  RecordProperty("microseconds_a_ray", std::to_string(passed.count() * 10));
  EXPECT_LT(passed.count(), 2) << "for " << ways.size() << " rays";
}

/// A post in the floor with a weight of 2 kg on an arm, 0.5 m off it.
std::string scale() {
  return R"(<sdf version='1.9'><model name='m'>
    <link name='post'><inertial><mass>50</mass></inertial></link>
    <link name='arm'><pose>0 0 1 0 0 0</pose>
      <inertial><pose>0.5 0 0 0 0 0</pose><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy>
        <izz>0.1</izz></inertia></inertial></link>
    <joint name='ground' type='fixed'><parent>world</parent><child>post</child></joint>
    <joint name='shoulder' type='fixed'><parent>post</parent><child>arm</child></joint>
  </model></sdf>)";
}

TEST(JointWrench, HoldsAWeightAndItsLeverage) {
  Warehouse w;
  w.spawnText(scale(), "m", 0, 0, 0, 1);
  w.run(1);
  const auto shoulder = w.world.jointWrench("m", "shoulder");
  ASSERT_TRUE(shoulder);
  EXPECT_NEAR(shoulder->force.Z(), 2 * 9.81, 0.1);
  EXPECT_NEAR(shoulder->torque.Y(), -0.5 * 2 * 9.81, 0.1);
  EXPECT_NEAR(w.world.jointWrench("m", "ground")->force.Z(), 52 * 9.81, 2);
  EXPECT_FALSE(w.world.jointWrench("m", "elbow"));
  EXPECT_FALSE(w.world.jointWrench("nothing", "shoulder"));
}

TEST(SetVelocity, MovesAModelAsOneAndLeavesItsJointsTurning) {
  Warehouse w;
  const std::string cart = R"(<sdf version='1.9'><model name='m'>
    <link name='base'><gravity>false</gravity></link>
    <link name='wheel'><pose>0 1 0 0 0 0</pose><gravity>false</gravity></link>
    <joint name='axle' type='continuous'><parent>base</parent><child>wheel</child>
      <axis><xyz>0 1 0</xyz></axis></joint></model></sdf>)";
  w.spawnText(cart, "m", 0, 0, 0, 5);
  JointSettings settings = w.world.joint("m", "axle")->settings;
  settings.motor_speed = 3;
  settings.motor_effort = 10;
  w.world.setJoint("m", "axle", settings);
  w.run(1);
  ASSERT_TRUE(w.world.setVelocity("m", {{1, 0, 0}, {0, 0, 2}}));
  const Twist base = w.world.state("m", "base")->twist, wheel = w.world.state("m", "wheel")->twist;
  EXPECT_NEAR((base.linear - Vector3(1, 0, 0)).Length(), 0, 1e-9);
  EXPECT_NEAR((wheel.linear - Vector3(-1, 0, 0)).Length(), 0, 0.05);
  w.world.step();
  EXPECT_NEAR(w.world.joint("m", "axle")->rate, 3, 0.05);
  EXPECT_FALSE(w.world.setVelocity("nothing", {}));
  EXPECT_THROW(w.world.setVelocity("m", {{std::nan(""), 0, 0}, {}}), DescriptionError);
}

}  // namespace
}  // namespace kiva::test
