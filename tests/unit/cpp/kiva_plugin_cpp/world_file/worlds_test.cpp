// SPDX-License-Identifier: Apache-2.0
//
// The models and worlds that come with the simulator have the properties that other code relies on.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "kiva_plugin_cpp/world_file.h"

namespace kiva {
namespace {

namespace fs = std::filesystem;

const fs::path kWorlds = WORLDS_DIR;
const ModelPaths kPaths{(kWorlds / "models").string()};

WorldDescription load(const std::string& name) {
  std::vector<std::string> warnings;
  WorldDescription world = loadWorld((kWorlds / (name + ".sdf")).string(), kPaths, &warnings);
  EXPECT_EQ(warnings, std::vector<std::string>()) << name;
  return world;
}

ModelDescription model(const std::string& name) {
  std::vector<std::string> warnings;
  const auto models =
      parseModels("<sdf version='1.9'><include><uri>model://" + name + "</uri></include></sdf>",
                  kPaths, name, &warnings);
  EXPECT_EQ(warnings, std::vector<std::string>()) << name;
  EXPECT_EQ(models.at(0).name, name);
  return *models.at(0).description;
}

std::map<std::string, ModelInstance> byName(const WorldDescription& world) {
  std::map<std::string, ModelInstance> models;
  for (const ModelInstance& instance : world.models) models[instance.name] = instance;
  return models;
}

const Collision& collision(const Link& link, const std::string& name) {
  for (const Collision& c : link.collisions) {
    if (c.name == name) return c;
  }
  throw std::out_of_range(name);
}

const Joint& joint(const ModelDescription& description, const std::string& name) {
  for (const Joint& j : description.joints) {
    if (j.name == name) return j;
  }
  throw std::out_of_range(name);
}

TEST(Worlds, AllReadWithoutWarnings) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(kWorlds)) {
    if (entry.path().extension() != ".sdf") continue;
    const WorldDescription world = load(entry.path().stem().string());
    EXPECT_EQ(byName(world).count("ground_plane"), 1u) << entry.path();
    EXPECT_EQ(world.gravity, Vector3(0, 0, -9.81));
    EXPECT_EQ(world.plugins.at(0).name, "grid");
    EXPECT_EQ(world.plugins.at(0).parameters.number("spacing", 0, 0, 9), 1.0);
    ++count;
  }
  EXPECT_GE(count, 4);
}

TEST(Worlds, StandTheirRobotsAndUnitsOnGridPoints) {
  for (const char* name : {"paper", "obstacles"}) {
    for (const ModelInstance& instance : load(name).models) {
      if (instance.name.find("item") == 0) continue;
      const Vector3 at = instance.pose.Pos();
      EXPECT_EQ(at, Vector3(std::round(at.X()), std::round(at.Y()), 0)) << instance.name;
    }
  }
}

TEST(Worlds, EmptyIsAHundredMetresWide) {
  const WorldDescription world = load("empty");
  ASSERT_EQ(world.models.size(), 1u);
  const Collision& floor = world.models[0].description->links[0].collisions[0];
  EXPECT_TRUE(world.models[0].description->is_static);
  EXPECT_EQ(floor.shape.kind, Shape::Kind::kPlane);
  EXPECT_EQ(floor.shape.plane_size[0], 100);
  EXPECT_EQ(floor.friction, 1);
}

TEST(Worlds, HallLeavesTheOuterGridPointsFree) {
  const auto models = byName(load("hall"));
  const auto innerFace = [&](const std::string& wall, int axis) {
    const ModelInstance& instance = models.at(wall);
    const Shape& box = instance.description->links[0].collisions[0].shape;
    return std::abs(instance.pose.Pos()[axis]) - box.size[axis] / 2;
  };
  EXPECT_NEAR(innerFace("wall_north", 1), 6.1, 1e-9);
  EXPECT_NEAR(innerFace("wall_south", 1), 6.1, 1e-9);
  EXPECT_NEAR(innerFace("wall_east", 0), 6.1, 1e-9);
  EXPECT_NEAR(innerFace("wall_west", 0), 6.1, 1e-9);
}

TEST(Worlds, PaperHasItemsOnTheBoardsOfItsUnits) {
  const auto models = byName(load("paper"));
  EXPECT_EQ(models.count("kiva2"), 1u);
  EXPECT_EQ(models.count("conveyor_belt2"), 1u);
  for (const auto& [name, item] : models) {
    if (name.find("item") != 0) continue;
    int boards = 0;
    for (const auto& [unit_name, unit] : models) {
      if (unit_name.find("storage_unit") != 0) continue;
      const Vector3 in_unit = item.pose.Pos() - unit.pose.Pos();
      const double tier = (in_unit.Z() - 0.46) / 0.35;
      if (std::abs(in_unit.X()) <= 0.28 && std::abs(in_unit.Y()) <= 0.3 &&
          std::abs(tier - std::round(tier)) < 1e-9) {
        ++boards;
      }
    }
    EXPECT_EQ(boards, 1) << name;
  }
}

TEST(Kiva, WeighsAndMeasuresWhatItShould) {
  const ModelDescription kiva = model("kiva");
  EXPECT_EQ(kiva.links.at(0).name, "chassis");
  double mass = 0;
  for (const Link& link : kiva.links) mass += link.mass;
  EXPECT_NEAR(mass, 145, 1e-9);
  const Collision& body = collision(kiva.links[0], "body");
  EXPECT_EQ(body.shape.size, Vector3(0.76, 0.64, 0.33));
  EXPECT_NEAR(body.pose_in_link.Pos().Z() - 0.33 / 2, 0.03, 1e-12);
  const Link& tower = *kiva.findLink("tower");
  const Collision& plate = tower.collisions.at(0);
  EXPECT_NEAR(tower.pose_in_model.Pos().Z() + plate.shape.length / 2, 0.40, 1e-12);
}

TEST(Kiva, StandsOnItsWheelsAndCasters) {
  const ModelDescription kiva = model("kiva");
  for (const char* name : {"caster_front", "caster_rear"}) {
    const Collision& caster = collision(kiva.links[0], name);
    EXPECT_EQ(caster.friction, 0);
    // Never beneath the floor, and near enough to it that the chassis can't rock.
    const double gap = caster.pose_in_link.Pos().Z() - caster.shape.radius;
    EXPECT_GE(gap, -1e-12);
    EXPECT_LE(gap, 0.002);
  }
  for (const auto& [name, y] : {std::pair{"left_wheel", 0.26}, std::pair{"right_wheel", -0.26}}) {
    const Link& wheel = *kiva.findLink(name);
    const Collision& tyre = wheel.collisions.at(0);
    EXPECT_EQ(wheel.pose_in_model.Pos(), Vector3(0, y, 0.1));
    EXPECT_EQ(tyre.shape.radius, 0.1);
    EXPECT_EQ(tyre.friction, 0.8);
    // A cylinder stands along z; the axle lies along y.
    const Vector3 axle = tyre.pose_in_link.Rot().RotateVector(Vector3::UnitZ);
    EXPECT_NEAR(std::abs(axle.Y()), 1, 1e-12);
  }
}

TEST(Kiva, HasTheJointsOfAWheeledLift) {
  const ModelDescription kiva = model("kiva");
  for (const char* wheel : {"left_wheel_joint", "right_wheel_joint"}) {
    EXPECT_EQ(joint(kiva, wheel).kind, Joint::Kind::kContinuous);
    EXPECT_EQ(joint(kiva, wheel).axis_in_model, Vector3::UnitY);
  }
  const Joint& tower = joint(kiva, "tower_joint");
  EXPECT_EQ(tower.kind, Joint::Kind::kPrismatic);
  EXPECT_EQ(tower.axis_in_model, Vector3::UnitZ);
  EXPECT_EQ(tower.lower, 0);
  EXPECT_EQ(tower.upper, 0.10);
}

/// A solid that fits the shape has about this inertia; a slip of the pen has not.
TEST(Kiva, HasTheInertiaOfItsShapes) {
  const ModelDescription kiva = model("kiva");
  const Vector3 size = collision(kiva.links[0], "body").shape.size;
  const double x = size.X() * size.X(), y = size.Y() * size.Y(), z = size.Z() * size.Z();
  const Vector3 box = Vector3(y + z, x + z, x + y) * 130 / 12;
  EXPECT_NEAR(kiva.links[0].principal_moments.Distance(box), 0, 1e-2);
  const Vector3 wheel = kiva.findLink("left_wheel")->principal_moments;
  EXPECT_NEAR(wheel.Y(), 0.5 * 2.5 * 0.1 * 0.1, 1e-5);
}

TEST(Kiva, BringsItsPlugins) {
  const ModelDescription kiva = model("kiva");
  std::map<std::string, std::string> files;
  for (const PluginDescription& plugin : kiva.plugins) files[plugin.name] = plugin.filename;
  EXPECT_EQ(files, (std::map<std::string, std::string>{{"motion", "libkiva_motion.so"},
                                                       {"rotation", "libkiva_rotation.so"},
                                                       {"lift", "libkiva_lift.so"},
                                                       {"laser", "libkiva_laser.so"}}));
}

TEST(StorageUnit, LetsARobotPassAndTurnBetweenItsLegs) {
  const Link shelf = model("storage_unit").links.at(0);
  EXPECT_EQ(shelf.mass, 60);
  EXPECT_EQ(shelf.collisions.size(), 5u);
  for (const Collision& segment : shelf.collisions) {
    if (segment.name.find("leg_") != 0) continue;
    const Vector3 at = segment.pose_in_link.Pos();
    const Vector3 half = segment.shape.size / 2;
    EXPECT_NEAR(at.Z() - half.Z(), 0, 1e-12);
    const double inner = std::hypot(std::abs(at.X()) - half.X(), std::abs(at.Y()) - half.Y());
    EXPECT_GT(inner, std::hypot(0.38, 0.32));  // The robot's corners.
  }
  const Collision& boards = collision(shelf, "shelf");
  EXPECT_NEAR(boards.pose_in_link.Pos().Z() - boards.shape.size.Z() / 2, 0.43, 1e-12);
  EXPECT_NEAR(boards.pose_in_link.Pos().Z() + boards.shape.size.Z() / 2, 1.80, 1e-12);
}

/// Nothing that is drawn reaches beneath the floor or far beyond what touches.
TEST(Models, AreDrawnWhereTheyAre) {
  const std::map<std::string, double> heights = {{"kiva", 0.40},   {"storage_unit", 1.80},
                                                 {"item", 0.1206}, {"conveyor_belt", 0.60},
                                                 {"wall", 1.5},    {"person", 1.75}};
  for (const auto& [name, height] : heights) {
    double top = 0;
    for (const Link& link : model(name).links) {
      EXPECT_FALSE(link.visuals.empty()) << name;
      EXPECT_FALSE(link.collisions.empty()) << name;
      for (const Visual& visual : link.visuals) {
        const Shape& shape = visual.shape;
        EXPECT_TRUE(shape.kind == Shape::Kind::kBox || shape.kind == Shape::Kind::kSphere ||
                    shape.kind == Shape::Kind::kCylinder);
        const Pose pose = link.pose_in_model * visual.pose_in_link;
        const bool lies = std::abs(pose.Rot().RotateVector(Vector3::UnitZ).Z()) < 0.5;
        const double half = shape.kind == Shape::Kind::kBox ? shape.size.Z() / 2
                            : shape.kind == Shape::Kind::kCylinder
                                ? (lies ? shape.radius : shape.length / 2)
                                : shape.radius;
        EXPECT_GE(pose.Pos().Z() - half, -1e-9) << name << " " << visual.name;
        top = std::max(top, pose.Pos().Z() + half);
      }
    }
    EXPECT_NEAR(top, height, 0.01) << name;
  }
}

TEST(Models, StandStillWhereTheyShould) {
  for (const char* name : {"conveyor_belt", "wall", "person"}) EXPECT_TRUE(model(name).is_static);
  for (const char* name : {"kiva", "storage_unit", "item"}) EXPECT_FALSE(model(name).is_static);
}

}  // namespace
}  // namespace kiva
