// SPDX-License-Identifier: Apache-2.0
//
// What lasers see: the grid of footprints against Bullet's own rays, and REP 117.
#include <random>

#include "core/engagement.h"
#include "core/parts.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Robots, units, belts, walls and people at random places and angles, all of them in Bullet.
class Scene {
 public:
  explicit Scene(unsigned seed) : random_(seed) {
    for (int i = 1; i <= 12; ++i) {
      for (const char* kind : {"kiva", "storage_unit", "conveyor_belt", "wall", "person"}) {
        w.spawn(kind, kind + std::to_string(i), uniform(-12, 12), uniform(-12, 12),
                uniform(-M_PI, M_PI));
      }
    }
    Parts& parts = w.world.parts();
    for (auto& model : parts.models) {
      const bool moves = model->kind == ModelKind::kRobot || model->kind == ModelKind::kStorageUnit;
      if (moves) engage(parts, *model);
    }
  }

  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  Warehouse w;

 private:
  std::mt19937 random_;
};

/// Whether a point is within anything that stands there; where a ray that starts inside a body
/// ends is nobody's business.
bool isInside(const Parts& parts, const Vector3& point) {
  Footprint here;
  here.kind = Footprint::Kind::kCircle;
  here.x = point.X();
  here.y = point.Y();
  bool inside = false;
  parts.obstacles.near(here.x, here.y, 0, [&](const Footprint& f) {
    inside = inside || (gap(f, here) < 0 && f.z_min <= point.Z() && point.Z() <= f.z_max);
  });
  return inside;
}

bool agree(double a, double b) {
  return a == b || std::abs(a - b) < 1e-4;  // a == b: both see nothing
}

TEST(Laser, SeesWhatBulletsRaysMeet) {
  int hits = 0, disagreements = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Scene scene(seed);
    const World& world = scene.w.world;
    for (int ray = 0; ray < 2000; ++ray) {
      const Vector3 from(scene.uniform(-13, 13), scene.uniform(-13, 13), scene.uniform(0.1, 0.35));
      if (isInside(scene.w.world.parts(), from)) continue;
      const double yaw = scene.uniform(-M_PI, M_PI), range = 5;
      const Vector3 direction(std::cos(yaw), std::sin(yaw), 0);
      const double seen = world.rayCast(from, yaw, range);
      const double truth = world.parts().physics.cast(from, direction, range);
      hits += std::isfinite(truth);
      if (agree(seen, truth) || truth == 0) continue;  // 0: it starts on a surface
      ++disagreements;
    }
  }
  // Bullet's rays against convex shapes are iterative and miss, or meet, an edge by millimetres.
  EXPECT_LT(disagreements, hits / 200);
  EXPECT_GT(hits, 5000);
}

std::vector<float> scan(const Warehouse& w, int id) {
  std::vector<float> ranges;
  w.world.scan(w.index(id), &ranges);
  return ranges;
}

TEST(Laser, RangesAreThoseOfAWallAhead) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawn("wall", "wall1", 3.1, 0, kQuarter);  // its face is at x = 3, from y = -0.5 to 0.5
  const std::vector<float> ranges = scan(w, 1);
  const LaserParameters& laser = w.robot(1).laser;
  ASSERT_EQ(static_cast<int>(ranges.size()), laser.rays);
  for (int i = 0; i < laser.rays; ++i) {
    const double angle =
        laser.min_angle + (laser.max_angle - laser.min_angle) * i / (laser.rays - 1);
    const double range = (3 - laser.x) / std::cos(angle);
    const bool hits = std::abs(range * std::sin(angle)) < 0.499;
    const bool misses = std::abs(range * std::sin(angle)) > 0.501;
    if (hits) {
      EXPECT_NEAR(ranges[i], range, 1e-4);
    } else if (misses) {
      EXPECT_EQ(ranges[i], kInfinity);
    }
  }
}

TEST(Laser, SeesBetweenTheLegsOfAUnit) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawn("storage_unit", "storage_unit1", 2, 0);
  w.spawn("wall", "wall1", 4.1, 0, kQuarter);
  const std::vector<float> ranges = scan(w, 1);
  EXPECT_NEAR(ranges[ranges.size() / 2], 4 - 0.38, 1e-4);
  EXPECT_EQ(std::count_if(ranges.begin(), ranges.end(), [](float r) { return r < 2.2; }) > 0, true)
      << "no leg was seen";
}

TEST(Laser, SeesNeitherItselfNorItsLoad) {
  Warehouse w;
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  w.spawnText(kivaText({{"min_angle", "-3.14"}, {"max_angle", "3.14"}}), "kiva1", 0, 0);
  w.carry(1, 1);
  w.runUntilIdle(1);
  for (float range : scan(w, 1)) EXPECT_EQ(range, kInfinity);
}

TEST(Laser, ReportsWhatIsNearerThanItsMinimumAsMinusInfinity) {
  Warehouse w;
  w.spawnText(kivaText({{"min_range", "0.5"}}), "kiva1", 0, 0);
  w.spawn("wall", "wall1", 0.8, 0, kQuarter);  // its face is 0.32 m before the sensor
  const std::vector<float> ranges = scan(w, 1);
  EXPECT_EQ(ranges[ranges.size() / 2], -kInfinity);
}

TEST(Laser, ScansOfAFleetAreSpreadOverThePeriod) {
  Warehouse w;
  for (int id = 1; id <= 50; ++id) w.spawn("kiva", "kiva" + std::to_string(id), 2 * id - 50, 0);
  std::vector<int> scans(51, 0);
  int most = 0;
  w.run(1, [&] {
    for (int robot : w.world.scansDue()) ++scans[w.world.fleet().robots[robot].id];
    most = std::max(most, static_cast<int>(w.world.scansDue().size()));
  });
  for (int id = 1; id <= 50; ++id) EXPECT_EQ(scans[id], 10) << "kiva" << id;
  EXPECT_LE(most, 3);
}

}  // namespace
}  // namespace kiva::test
