// SPDX-License-Identifier: Apache-2.0
//
// Scans of lasers: the grid of footprints against Bullet's own rays, and REP 117.
#include <btBulletDynamicsCommon.h>

#include <random>

#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr double kLowest = 0.05, kHighest = 0.35;  // [m], of the rays

/// A round shape as a prism of so many sides that rays that just touch it are right too.
constexpr int kSides = 8192;

/// Returns whether rays can meet the shape: casters and wheels are within their robot's body.
bool isSeen(const Shape& shape, const btTransform& at) {
  if (shape.kind == Shape::Kind::kBox) return true;
  const bool upright = at.getBasis().getColumn(2).z() > 0.999;
  return shape.kind == Shape::Kind::kCylinder && upright &&
         at.getOrigin().z() - shape.length / 2 < kHighest;
}

/// The sides of a box or an upright cylinder.
void addTriangles(const Shape& shape, const btTransform& at, btTriangleMesh* mesh) {
  if (!isSeen(shape, at)) return;
  const bool is_box = shape.kind == Shape::Kind::kBox;
  const int sides = is_box ? 4 : kSides;
  const double half = (is_box ? shape.size.Z() : shape.length) / 2;
  const auto corner = [&](int k, double z) {
    if (is_box) {
      const double x = k % 4 == 0 || k % 4 == 3 ? 0.5 : -0.5, y = k % 4 < 2 ? 0.5 : -0.5;
      return at * btVector3(x * shape.size.X(), y * shape.size.Y(), z);
    }
    const double angle = 2 * M_PI * k / sides;
    return at * btVector3(shape.radius * std::cos(angle), shape.radius * std::sin(angle), z);
  };
  for (int k = 0; k < sides; ++k) {
    mesh->addTriangle(corner(k, -half), corner(k + 1, -half), corner(k + 1, half));
    mesh->addTriangle(corner(k, -half), corner(k + 1, half), corner(k, half));
  }
}

/// The sides of every collision of a world as triangles, for Bullet's rayTest: that is exact,
/// whereas its rays against convex shapes are iterative, and meet what they pass within a
/// centimetre.
class Triangles {
 public:
  explicit Triangles(const World& world) {
    for (const std::string& name : world.modelNames()) {
      if (world.kind(name) != ModelKind::kFloor) addModel(world, name);
    }
    shape_ = std::make_unique<btBvhTriangleMeshShape>(&mesh_, true);
    object_.setCollisionShape(shape_.get());
  }

  double cast(const Vector3& from, const Vector3& direction, double range) const {
    const btVector3 begin = toBullet(from), end = toBullet(from + direction * range);
    btCollisionWorld::ClosestRayResultCallback hit(begin, end);
    btCollisionWorld::rayTestSingle(btTransform(btQuaternion::getIdentity(), begin),
                                    btTransform(btQuaternion::getIdentity(), end), &object_,
                                    shape_.get(), btTransform::getIdentity(), hit);
    return hit.hasHit() ? hit.m_closestHitFraction * range : kInfinity;
  }

 private:
  void addModel(const World& world, const std::string& name) {
    for (const Link& link : world.description(name)->links) {
      const Pose pose = world.state(name, link.name)->pose;
      for (const Collision& collision : link.collisions) {
        addTriangles(collision.shape, toBullet(pose * collision.pose_in_link), &mesh_);
      }
    }
  }

  btTriangleMesh mesh_;
  std::unique_ptr<btBvhTriangleMeshShape> shape_;
  mutable btCollisionObject object_;
};

/// Robots, some with a load, units, belts, walls and people, near one another at random places and
/// angles.
class CrowdedScene {
 public:
  explicit CrowdedScene(unsigned seed, const std::string& robot = modelText("kiva"))
      : random_(seed) {
    for (int cell = 0; cell < kSide * kSide; ++cell) cells_.push_back(cell);
    std::shuffle(cells_.begin(), cells_.end(), random_);
    for (int i = 1; i <= 12; ++i) {
      const std::string number = std::to_string(i), laden = std::to_string(i + 12);
      for (const char* kind : {"storage_unit", "conveyor_belt", "wall", "person"}) {
        const Pose at = place();
        w.spawn(kind, kind + number, at.X(), at.Y(), at.Rot().Yaw());
      }
      for (const std::string& id : {number, laden}) {
        const Pose at = place();
        w.spawnText(robot, "kiva" + id, at.X(), at.Y(), at.Rot().Yaw());
      }
      const Pose at = w.world.state("kiva" + laden)->pose;
      w.spawn("storage_unit", "storage_unit" + laden, at.X(), at.Y(), at.Rot().Yaw());
      w.carry(i + 12, i + 12);
    }
    w.run(uniform(0.5, 3));  // towers are somewhere on their way
  }

  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  Warehouse w;

 private:
  static constexpr int kSide = 9;          // cells
  static constexpr double kSpacing = 2.6;  // [m]: nothing touches its neighbour

  /// Somewhere in a cell that nothing else is in.
  Pose place() {
    const int cell = cells_.back();
    cells_.pop_back();
    const double x = (cell % kSide - kSide / 2) * kSpacing + uniform(-0.25, 0.25);
    const double y = (cell / kSide - kSide / 2) * kSpacing + uniform(-0.25, 0.25);
    return Pose(x, y, 0, 0, 0, uniform(-M_PI, M_PI));
  }

  std::mt19937 random_;
  std::vector<int> cells_;
};

/// Returns whether a point is inside any model: a ray that starts inside passes out.
bool isInside(const kiva::Scene& parts, const Vector3& point) {
  Footprint here;
  here.kind = Footprint::Kind::kCircle;
  here.x = point.X();
  here.y = point.Y();
  bool inside = false;
  parts.obstacles.near(here.x, here.y, 0, [&](const Footprint& f) {
    inside = inside || (gap(f, here) <= 0 && f.z_min <= point.Z() && point.Z() <= f.z_max);
  });
  return inside;
}

/// One ray of a scene.
struct Ray {
  Vector3 from;
  double yaw;
  double cast(const World& world, double aside = 0) const {
    const Vector3 left(-std::sin(yaw), std::cos(yaw), 0);
    return world.rayCast(from + left * aside, yaw, kRange);
  }
  double cast(const Triangles& triangles) const {
    return triangles.cast(from, {std::cos(yaw), std::sin(yaw), 0}, kRange);
  }
  static constexpr double kRange = 5;  // [m]
};

/// Returns whether the expected range is that of a ray a third of a millimetre aside, or in
/// between: Bullet takes a triangle for larger than it is by a ten-thousandth of its edges.
bool isAtEdge(const World& world, const Ray& ray, double truth) {
  const double ranges[] = {ray.cast(world), ray.cast(world, 3e-4), ray.cast(world, -3e-4)};
  return truth >= *std::min_element(ranges, ranges + 3) - 3e-4 &&
         truth <= *std::max_element(ranges, ranges + 3) + 3e-4;
}

TEST(Laser, SeesWhatBulletsRaysMeet) {
  int hits = 0, rays = 0, edges = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    CrowdedScene scene(seed);
    const World& world = scene.w.world;
    const Triangles triangles(world);
    for (int k = 0; k < 6000; ++k) {
      const Ray ray{
          {scene.uniform(-13, 13), scene.uniform(-13, 13), scene.uniform(kLowest, kHighest)},
          scene.uniform(-M_PI, M_PI)};
      if (isInside(insideOf(world).view, ray.from)) continue;
      const double range = ray.cast(world), truth = ray.cast(triangles);
      ++rays;
      hits += std::isfinite(truth);
      if (range == truth || std::abs(range - truth) < 1e-4) continue;  // ==: both see nothing
      ++edges;
      ASSERT_TRUE(isAtEdge(world, ray, truth))
          << "scene " << seed << ", from " << ray.from << " at " << ray.yaw << ": " << range
          << ", not " << truth;
    }
  }
  EXPECT_GT(rays, 100000);
  EXPECT_GT(hits, 30000);
  EXPECT_LT(edges, rays / 5000);
}

/// Compares each range of a robot's scan with that of its ray alone. Returns the number of rays
/// with a hit.
int compareScan(const Warehouse& w, int id) {
  const Robot& robot = w.robot(id);
  const LaserParameters& laser = robot.laser;
  const EntityState at = *w.world.state(robot.name);
  const double yaw = at.pose.Rot().Yaw();
  const Vector3 ahead(std::cos(yaw), std::sin(yaw), 0);
  const Vector3 from = at.pose.Pos() + ahead * laser.x + Vector3(0, 0, laser.z);
  std::vector<float> ranges;
  w.world.scan(w.index(id), &ranges);
  int hits = 0;
  for (int k = 0; k < laser.rays; ++k) {
    const double turn =
        laser.min_angle + (laser.max_angle - laser.min_angle) * k / std::max(1, laser.rays - 1);
    // At an edge what is a rounding error aside counts as well.
    const auto isSeen = [&](double aside) {
      const double ray = w.world.rayCast(from, yaw + turn + aside, laser.max_range, robot.name);
      const bool is_near = ray < laser.min_range;
      return is_near ? ranges[k] == -kInfinity
                     : ranges[k] == ray || std::abs(ranges[k] - ray) < 1e-5;
    };
    EXPECT_TRUE(isSeen(0) || isSeen(1e-9) || isSeen(-1e-9))
        << robot.name << ", ray " << k << ": " << ranges[k] << ", alone "
        << w.world.rayCast(from, yaw + turn, laser.max_range, robot.name);
    hits += std::isfinite(ranges[k]);
  }
  return hits;
}

TEST(Laser, ScansWhatItsRaysMeetOneByOne) {
  const Changes lasers[] = {
      {},  // 120° ahead
      {{"min_angle", "-3.14159265358979"}, {"max_angle", "3.14159265358979"}, {"rays", "721"}},
      {{"min_angle", "0.3"}, {"max_angle", "3"}, {"rays", "50"}, {"z", "0.05"}},
      {{"min_angle", "-1"}, {"max_angle", "-1"}, {"rays", "1"}, {"x", "0.1"}}};
  int hits = 0;
  unsigned seed = 0;
  for (const Changes& laser : lasers) {
    for (int round = 0; round < 3; ++round) {
      CrowdedScene scene(++seed, kivaText(laser));
      for (int id = 1; id <= 24; ++id) hits += compareScan(scene.w, id);
    }
  }
  EXPECT_GT(hits, 10000);
}

// --- round and tilted shapes, against what their own equations say

struct SolidCase {
  std::string name, geometry;
  /// Whether a point in the shape's frame is in it.
  bool (*holds)(const Vector3&);
};

double beyond(double value, double half) { return std::max(0.0, std::abs(value) - half); }

const SolidCase kSolids[] = {
    {"Ellipsoid", "<ellipsoid><radii>0.6 0.3 0.2</radii></ellipsoid>",
     [](const Vector3& p) {
       return std::pow(p.X() / 0.6, 2) + std::pow(p.Y() / 0.3, 2) + std::pow(p.Z() / 0.2, 2) <= 1;
     }},
    {"Capsule", "<capsule><radius>0.25</radius><length>0.7</length></capsule>",
     [](const Vector3& p) { return std::hypot(p.X(), p.Y(), beyond(p.Z(), 0.35)) <= 0.25; }},
    {"Cylinder", "<cylinder><radius>0.3</radius><length>0.5</length></cylinder>",
     [](const Vector3& p) { return std::hypot(p.X(), p.Y()) <= 0.3 && std::abs(p.Z()) <= 0.25; }},
    {"Box", "<box><size>0.4 0.6 0.8</size></box>", [](const Vector3& p) {
       return std::abs(p.X()) <= 0.2 && std::abs(p.Y()) <= 0.3 && std::abs(p.Z()) <= 0.4;
     }}};

class SolidUnderLaser : public ::testing::TestWithParam<SolidCase> {};

TEST_P(SolidUnderLaser, IsSeenWhereItIsFromOutsideAndInside) {
  std::mt19937 random(7);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  constexpr double kStep = 0.002, kRange = 3;  // [m]
  int hits = 0, inner = 0, grazing = 0, rays = 0;
  for (int round = 0; round < 40; ++round) {
    Warehouse w;
    const Pose pose(0.1, -0.2, uniform(-0.2, 0.6), uniform(-3, 3), uniform(-1.5, 1.5),
                    uniform(-3, 3));
    const bool moves = round % 2;  // both ways to be an obstacle: of a body, and of none
    w.world.spawn(instance("<sdf version='1.9'><model name='m'><static>" +
                               std::string(moves ? "false" : "true") +
                               "</static><link name='l'><gravity>false</gravity><collision "
                               "name='c'><geometry>" +
                               GetParam().geometry + "</geometry></collision></link></model></sdf>",
                           "m", pose));
    for (int k = 0; k < 100; ++k) {
      const Vector3 from(uniform(-1, 1), uniform(-1, 1), uniform(0, 0.4));
      const double yaw = uniform(-M_PI, M_PI);
      const Vector3 way(std::cos(yaw), std::sin(yaw), 0);
      const auto in = [&](double t) {
        return GetParam().holds(pose.Rot().RotateVectorReverse(from + way * t - pose.Pos()));
      };
      const bool starts_in = in(0);
      double crossed = std::numeric_limits<double>::infinity();
      for (double t = 0; t < kRange && std::isinf(crossed); t += kStep) {
        if (in(t + kStep) == starts_in) continue;
        double near = t, far = t + kStep;
        for (int halving = 0; halving < 40; ++halving) {
          const double middle = (near + far) / 2;
          (in(middle) == starts_in ? near : far) = middle;
        }
        crossed = far;
      }
      const double range = w.world.rayCast(from, yaw, kRange);
      ++rays;
      hits += std::isfinite(crossed);
      inner += starts_in;
      if (std::isinf(crossed) && std::isfinite(range)) {  // shorter than a step
        ++grazing;
        EXPECT_TRUE(in(range + 1e-9) || in(range + 1e-6));
      } else if (std::isfinite(crossed)) {
        if (crossed > range + kStep) {
          ++grazing;
          continue;
        }
        EXPECT_NEAR(range, crossed, 1e-8);
      } else {
        EXPECT_TRUE(std::isinf(range));
      }
    }
  }
  EXPECT_GT(hits, rays / 8);
  EXPECT_GT(inner, 20);
  EXPECT_LT(grazing, 20);
}
INSTANTIATE_TEST_SUITE_P(Shapes, SolidUnderLaser, ::testing::ValuesIn(kSolids),
                         [](const auto& info) { return info.param.name; });

TEST(Laser, SeesTheInsideOfWhatItIsIn) {
  Warehouse w;
  const auto add = [&](const std::string& name, const std::string& geometry) {
    w.world.spawn(
        instance("<sdf version='1.9'><model name='m'><static>true</static><link "
                 "name='l'><collision name='c'><geometry>" +
                     geometry + "</geometry></collision></link></model></sdf>",
                 name, Pose(0, 0, 0.2, 0, 0, 0)));
  };
  const Vector3 from(0.1, 0, 0.2);
  const std::pair<const char*, double> shapes[] = {
      {"<box><size>1 1 1</size></box>", 0.4},
      {"<sphere><radius>0.5</radius></sphere>", 0.4},
      {"<cylinder><radius>0.5</radius><length>1</length></cylinder>", 0.4},
      {"<capsule><radius>0.5</radius><length>1</length></capsule>", 0.4},
      {"<ellipsoid><radii>0.5 0.4 0.3</radii></ellipsoid>", 0.4}};
  for (const auto& [geometry, distance] : shapes) {
    add("m", geometry);
    EXPECT_NEAR(w.world.rayCast(from, 0, 5), distance, 1e-9) << geometry;
    EXPECT_NEAR(w.world.rayCast(from, M_PI, 5), distance + 0.2, 1e-9) << geometry;
    w.world.remove("m");
  }
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
      << "no segment was seen";
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

TEST(RayCast, PassesTheModelThatItIsToldToPass) {
  Warehouse w;
  w.spawn("wall", "near", 0, 0);
  w.spawn("wall", "far", 3, 0);
  EXPECT_LT(w.world.rayCast({-1, 0, 0.2}, 0, 10), 2);
  const double range = w.world.rayCast({0, 0, 0.2}, 0, 10, "near");
  EXPECT_GT(range, 1);
  EXPECT_LT(range, 3);
}

}  // namespace
}  // namespace kiva::test
