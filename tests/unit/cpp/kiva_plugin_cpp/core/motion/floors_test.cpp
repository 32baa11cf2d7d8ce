// SPDX-License-Identifier: Apache-2.0
//
// Surfaces on which wheels can drive are floor, however a world is made: robots and storage units
// stand on it, and parts more than 3 cm above it are obstacles.
#include <gtest/gtest.h>

#include <algorithm>

#include "warehouse.h"

namespace kiva::test {
namespace {

const std::string kPlane =
    "<model name='plane'><static>1</static><link name='l'><collision name='c'><geometry><plane>"
    "<size>40 40</size></plane></geometry></collision></link></model>";
const std::string kPillar =  // beside the way of the robots: near enough for Bullet
    "<model name='pillar'><static>1</static><pose>1 0.6 0.5 0 0 0</pose><link name='l'>"
    "<collision name='c'><geometry><cylinder><radius>0.2</radius><length>1</length></cylinder>"
    "</geometry></collision></link></model>";

std::string box(const std::string& name, const std::string& size, const std::string& pose) {
  return "<model name='" + name + "'><static>1</static><pose>" + pose +
         " 0 0 0</pose><link name='l'><collision name='c'><geometry><box><size>" + size +
         "</size></box></geometry></collision></link></model>";
}

std::string mesh(const std::string& file) {
  return "<model name='hall'><static>1</static><link name='l'><collision name='c'><geometry><mesh>"
         "<uri>file://" TESTS_DIR "/worlds/meshes/" +
         file + "</uri></mesh></geometry></collision></link></model>";
}

WorldDescription describe(const std::string& models) {
  return parseWorld("<sdf version='1.6'><world name='w'>" + models +
                        "<plugin name='grid' filename='libkiva_grid.so'><spacing>1</spacing>"
                        "</plugin></world></sdf>",
                    modelPaths(), "test");
}

WorldOptions inBullet() {
  WorldOptions options;
  options.always_in_bullet = true;
  return options;
}

/// A warehouse in a world of those models.
struct Hall : Warehouse {
  explicit Hall(const std::string& models, const WorldOptions& options = {})
      : Warehouse(describe(models), options) {}
  bool isTaken(double x, double y) const {
    const Occupancy map = world.occupancy();
    const int column = std::lround((x - map.x) / map.spacing);
    const int row = std::lround((y - map.y) / map.spacing);
    if (column < 0 || row < 0 || column >= map.columns || row >= map.rows) return true;
    return map.cells[row * map.columns + column];
  }
};

struct Case {
  std::string name, models;
  double height;  // of the floor [m]
};

const Case kFloors[] = {
    {"a box with its top at 0", box("slab", "20 20 0.1", "0 0 -0.05"), 0},
    {"the same on a plane", kPlane + box("slab", "20 20 0.1", "0 0 -0.05"), 0},
    {"a box with its top at 3 cm", box("slab", "20 20 0.1", "0 0 -0.02"), 0.03},
    {"the same on a plane", kPlane + box("slab", "20 20 0.1", "0 0 -0.02"), 0.03},
    {"one of 8 cm on a plane", box("slab", "20 20 0.08", "0 0 0.04") + kPlane, 0.08},
    {"a box lower than 0", box("slab", "20 20 0.1", "0 0 -0.09"), -0.04},
    {"two boxes side by side",
     box("west", "10 20 0.1", "-5 0 -0.05") + box("east", "10 20 0.1", "5 0 -0.04"), 0.01},
    {"a mesh 3.4 cm above 0", mesh("hall_floor.obj"), 0.034},
    {"the same on a plane", mesh("hall_floor.obj") + kPlane, 0.034},
};

/// Robots touch no floor, be they in arrays or in Bullet.
TEST(Floors, CarryRobotsAsAPlaneDoes) {
  for (const Case& floor : kFloors) {
    for (const WorldOptions& options : {WorldOptions(), inBullet()}) {
      SCOPED_TRACE(floor.name);
      Hall w(floor.models + kPillar, options);
      w.spawn("kiva", "kiva1", 0, 0);
      w.movx(1, 3);
      w.runUntilIdle(1, 10);
      w.expectAt(1, 3, 0);
      w.movy(1, -2);
      w.runUntilIdle(1, 20);
      w.expectAt(1, 3, -2);
      EXPECT_EQ(w.count(Event::Kind::kCollision), 0);
      EXPECT_NEAR(w.world.state("kiva1")->pose.Z(), floor.height, 1e-6);
      EXPECT_EQ(w.world.rayCast({3, -2.5, floor.height + 0.2}, -M_PI / 2, 3), INFINITY);
      EXPECT_FALSE(w.isTaken(3, -2));
      EXPECT_TRUE(w.isTaken(1, 1));  // the pillar
    }
  }
}

TEST(Floors, CarryStorageUnitsAndTheirItems) {
  for (const Case& floor : kFloors) {
    if (floor.height < 0) continue;  // there they fall onto it
    SCOPED_TRACE(floor.name);
    Hall w(floor.models);
    w.spawn("storage_unit", "storage_unit1", 2, 0);
    w.spawn("item", "item1", 2, 0, 0, 0.46);
    w.spawn("kiva", "kiva1", 0, 0);
    const double above = w.itemPose("item1").Z() - w.unitPose(1).Z();
    EXPECT_NEAR(w.unitPose(1).Z(), floor.height, 1e-6);
    EXPECT_NEAR(above, 0.46, 1e-9);
    w.movx(1, 2);
    w.runUntilIdle(1, 10);
    w.carry(1, 1);
    w.runUntilIdle(1, 20);
    EXPECT_GE(w.unitPose(1).Z(), floor.height + 0.05 - 1e-6);
    w.movy(1, 2);
    w.runUntilIdle(1, 20);
    w.drop(1, 1);
    w.runUntilIdle(1, 20);
    EXPECT_NEAR(w.unitPose(1).Pos().Distance({2, 2, floor.height}), 0, 1e-3);
    EXPECT_EQ(w.carrierOf(1), 0);
    EXPECT_EQ(w.count(Event::Kind::kCollision), 0);
  }
}

TEST(Floors, HaveWallsOfTheSameMesh) {
  for (const std::string& models : {mesh("hall_floor.obj"), kPlane + mesh("hall_floor.obj")}) {
    Hall w(models);
    w.spawn("kiva", "kiva1", 3, 0);
    w.movx(1, 4);
    w.runUntilIdle(1, 20);
    EXPECT_EQ(w.last(Event::Kind::kBlocked).other, "hall");
    w.expectAt(1, 6, 0);
    EXPECT_TRUE(w.isTaken(7, 0));
    EXPECT_FALSE(w.isTaken(5, 0));
    EXPECT_TRUE(w.isTaken(12, 0));  // beyond the hall's floor, 3.4 cm lower
  }
}

TEST(Floors, HaveStepsOfThreeCentimetres) {
  Hall w(kPlane + box("mat", "0.5 3 0.03", "2 0 0.015") + box("kerb", "0.5 3 0.3", "5 0 -0.1"));
  EXPECT_FALSE(w.isTaken(2, 0));
  EXPECT_TRUE(w.isTaken(5, 0));
  w.spawn("kiva", "kiva1", 0, 0);
  w.movx(1, 3);
  w.runUntilIdle(1, 20);
  w.expectAt(1, 3, 0);
  EXPECT_NEAR(w.world.state("kiva1")->pose.Z(), 0, 1e-9);  // what lies on a plane is not the floor
  w.movx(1, 3);
  w.runUntil([&] { return w.count(Event::Kind::kBlocked) + w.count(Event::Kind::kCollision) > 0; },
             20);
  EXPECT_LT(w.x(1), 4.7);
}

TEST(Floors, EndWhereNothingLies) {
  Hall w(box("west", "6 6 0.1", "-4 0 -0.05") + box("east", "6 6 0.1", "6 0 -0.05"));
  EXPECT_FALSE(w.isTaken(-4, 0));
  EXPECT_FALSE(w.isTaken(6, 0));
  EXPECT_TRUE(w.isTaken(1, 0));  // the gap between them
}

/// A preset is not put on top of things where nothing can drive.
TEST(Floors, ThatAreNotThereLeaveNoCellFree) {
  Hall w(box("crate", "4 4 1", "0 0 0.5"));
  const Occupancy map = w.world.occupancy();
  EXPECT_GT(map.cells.size(), 0u);
  EXPECT_EQ(std::count(map.cells.begin(), map.cells.end(), Occupancy::kFree), 0);
}

TEST(Floors, ThatComeLaterLiftWhatStandsThere) {
  Hall w(kPlane);
  w.spawn("storage_unit", "storage_unit1", 2, 0);
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawnText("<sdf version='1.6'>" + box("slab", "20 20 0.05", "0 0 0") + "</sdf>", "slab", 0, 0,
              0, 0.025);
  EXPECT_NEAR(w.unitPose(1).Z(), 0.05, 1e-9);
  EXPECT_NEAR(w.world.state("kiva1")->pose.Z(), 0.05, 1e-9);
  w.world.remove("slab");
  EXPECT_NEAR(w.world.state("kiva1")->pose.Z(), 0, 1e-9);
}

TEST(Floors, ComeBackFromCheckpoints) {
  Hall w(mesh("hall_floor.obj") + kPlane);
  w.spawn("kiva", "kiva1", 0, 0);
  const std::string saved = w.world.checkpoint();
  w.movx(1, 3);
  w.runUntilIdle(1, 20);
  w.world.restore(saved);
  EXPECT_NEAR(w.world.state("kiva1")->pose.Z(), 0.034, 1e-6);
  EXPECT_FALSE(w.isTaken(5, 0));
  w.movx(1, 3);
  w.runUntilIdle(1, 20);
  w.expectAt(1, 3, 0);
}

TEST(Occupancy, TellsBeltsAndStorageUnitsFromTheBuilding) {
  Warehouse w;
  w.spawn("conveyor_belt", "conveyor_belt1", 3, 3);
  w.spawn("storage_unit", "storage_unit1", -2, 1);
  w.spawn("wall", "wall1", 6, 0);
  w.spawn("kiva", "kiva1", -2, 1);
  const auto at = [&](int x, int y) {
    const Occupancy map = w.world.occupancy();
    const int column = static_cast<int>(std::lround(x - map.x)), row = std::lround(y - map.y);
    return map.cells.at(row * map.columns + column);
  };
  EXPECT_EQ(at(3, 3), Occupancy::kBelt);
  EXPECT_EQ(at(-2, 1), Occupancy::kStorageUnit);
  EXPECT_EQ(at(-1, 1), Occupancy::kFree);
  EXPECT_EQ(at(6, 0), Occupancy::kTaken);
  w.carry(1, 1);
  w.runUntilIdle(1);
  EXPECT_EQ(at(-2, 1), Occupancy::kFree) << "it is on the robot now";
}

// --- what wheels cross as if it were level floor

/// Returns the warnings of a new world of those models.
std::string warningsOf(const std::string& models) {
  Hall hall(models);
  hall.step();
  std::string all;
  for (const std::string& warning : hall.world.takeWarnings()) all += warning + "\n";
  return all;
}

TEST(FloorWarnings, NameABumpThatRobotsCrossWithoutOne) {
  for (const std::string height : {"0.01", "0.02", "0.03"}) {
    const double z = std::stod(height) / 2;
    const std::string lying = box("bump", "0.5 0.5 " + height, "3 0 " + number(z));
    EXPECT_PRED2(contains, warningsOf(kPlane + lying), "bump rises " + height + " m above");
  }
  EXPECT_EQ(warningsOf(kPlane), "");
  EXPECT_EQ(warningsOf(kPlane + box("wall", "0.5 0.5 1", "3 0 0.5")), "");
}

TEST(FloorWarnings, NameAGapThatRobotsCross) {
  const auto slabs = [](double gap) {
    return box("west", "20 20 0.1", number(-10 + 2.3) + " 0 -0.05") +
           box("east", "20 20 0.1", number(10 + 2.3 + gap) + " 0 -0.05");
  };
  EXPECT_PRED2(contains, warningsOf(slabs(0.5)), "the floor has a gap beside (2, -9)");
  EXPECT_EQ(warningsOf(slabs(0)), "");
  EXPECT_EQ(warningsOf(slabs(0.02)), "");  // a joint
}

}  // namespace
}  // namespace kiva::test
