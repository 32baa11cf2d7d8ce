// SPDX-License-Identifier: Apache-2.0
//
// Rays in any direction, what joints do to their links, and velocities given to models: what
// sensors and drives that were written for Gazebo stand on.
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
    EXPECT_NEAR(cast(w.world, {0, 0, 0.4}, {std::cos(yaw), std::sin(yaw), 0}),
                w.world.rayCast({0, 0, 0.4}, yaw, 20), 1e-6)
        << ray;
  }
}

}  // namespace
}  // namespace kiva::test
