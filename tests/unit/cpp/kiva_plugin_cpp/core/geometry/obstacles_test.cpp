// SPDX-License-Identifier: Apache-2.0
//
// Queries around a point: each obstacle that is near enough is visited once, however models and
// robots were added, moved and removed. Scans: a fan's rays meet what each ray by itself meets.
#include "core/geometry/obstacles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "core/sensing/scans.h"

namespace kiva {
namespace {

constexpr double kEdge = 12;       // of the floor [m]
constexpr double kMargin = 0.005;  // by which more may be asked for [m]
constexpr int kThings = 150, kTurns = 20, kLooks = 25;
constexpr double kReach = 5;     // of a scan [m]
constexpr double kGraze = 1e-5;  // [rad], by which a ray that only just meets a corner may miss it
constexpr double kError = 1e-3;  // [m] in a surface's distance, for a ray turned by that

Footprint box(double x, double y, double hx = 0.3, double hy = 0.2) {
  Footprint out;
  out.x = x;
  out.y = y;
  out.hx = hx;
  out.hy = hy;
  out.z_min = -1;
  out.z_max = 1;
  return out;
}

/// A robot that is seen as two boxes, and one whose wheel and plate are hidden in its body.
const std::vector<Footprint> kTwoBoxes = {box(0, 0), box(0.2, 0.1)};
std::vector<Footprint> bodyWithParts() {
  Footprint wheel = circleAt(0.1, 0, 0.05), plate = circleAt(0, 0, 0.15);
  wheel.z_min = -2;
  plate.z_min = 0.5;
  wheel.z_max = plate.z_max = 2;
  return {wheel, box(0, 0), plate};
}

class BusyFloor {
 public:
  BusyFloor(int robots, unsigned seed, const std::vector<Footprint>& parts = kTwoBoxes)
      : obstacles_(fleet_), random_(seed) {
    for (int i = 0; i < robots; ++i) {
      for (auto* column : {&fleet_.x, &fleet_.y, &fleet_.yaw}) column->push_back(within(kEdge));
      std::vector<Footprint> own = parts;
      for (Footprint& part : own) part.model = i;
      obstacles_.setMover(i, own);
    }
    for (int i = 0; i < kThings; ++i) things_.push_back(obstacles_.add(anywhere()));
  }

  /// Robots drive, things are pushed, one goes and another comes.
  void turn() {
    for (std::size_t i = 0; i < fleet_.x.size(); ++i) {
      fleet_.x[i] += within(0.4) - 0.2;
      fleet_.y[i] += within(0.4) - 0.2;
      obstacles_.follow(static_cast<int>(i));
    }
    for (int& thing : things_) {
      if (within(1) < 0.1) obstacles_.update(thing, anywhere());
    }
    obstacles_.remove(things_.back());
    things_.back() = obstacles_.add(anywhere());
  }

  void look() {
    const double x = within(kEdge), y = within(kEdge), reach = within(1), far = reach + within(2);
    const double low = within(2);
    const Heights heights{low, low + within(1)};
    std::map<const Footprint*, int> things;
    std::map<int, int> robots;
    const auto meets = [&](const Footprint& thing) { return ++things[&thing] == 0; };
    const auto approaches = [&](int robot, double) { return ++robots[robot] == 0; };
    EXPECT_FALSE(obstacles_.anyAround(x, y, heights, reach, far, meets, approaches));
    for (const int thing : things_) {
      const Footprint& f = obstacles_[thing];
      const bool is_within = std::hypot(f.x - x, f.y - y) < reach + radiusOf(f);
      const bool is_at = f.z_min <= heights.high && heights.low <= f.z_max;
      const bool touches = is_at && is_within && boxIsNear(f, x, y, reach);
      const int asked = things[&f];
      EXPECT_LE(asked, 1);
      if (touches) {
        EXPECT_EQ(asked, 1);
      } else if (asked) {
        EXPECT_LE(distance(f, x, y), reach + kMargin);
        EXPECT_TRUE(is_at);
      }
    }
    for (std::size_t i = 0; i < fleet_.x.size(); ++i) {
      const double away = std::hypot(fleet_.x[i] - x, fleet_.y[i] - y);
      EXPECT_EQ(robots[static_cast<int>(i)], away < far + radius() ? 1 : 0);
    }
  }

  /// A scan of each robot, and of a laser that belongs to none.
  void scan(const RayFan& fan, double z) {
    for (int robot = -1; robot < static_cast<int>(fleet_.x.size()); ++robot) {
      const double yaw = robot < 0 ? within(6) : fleet_.yaw[robot];
      const double x = robot < 0 ? within(kEdge) : fleet_.x[robot];
      const double y = robot < 0 ? within(kEdge) : fleet_.y[robot];
      const Sensor from{x, y, z, std::cos(yaw), std::sin(yaw)};
      FanHits hits;
      obstacles_.cast(fan, from, {kReach, INFINITY}, robot, &hits);
      for (int ray = 0; ray < fan.rays; ++ray) {
        const double angle = yaw + std::atan2(fan.s[ray], fan.c[ray]);
        const bool is_hit = ray >= hits.first && ray <= hits.last && hits.model[ray] >= 0;
        const double range = is_hit ? hits.range[ray] : INFINITY;
        EXPECT_TRUE(isRight(range, from, angle, robot)) << "robot " << robot << ", ray " << ray;
        met_ += is_hit;
      }
    }
  }
  int met() const { return met_; }

 private:
  /// Returns whether a single ray meets something at that range, or one beside it does.
  bool isRight(double range, const Sensor& from, double angle, int robot) const {
    for (const double aside : {0.0, -kGraze, kGraze}) {
      const double c = std::cos(angle + aside), s = std::sin(angle + aside);
      const double other = obstacles_.cast(from.x, from.y, from.z, c, s, kReach, robot).range;
      if (range == other || std::abs(range - other) < kError) return true;
    }
    return false;
  }

  double within(double most) { return std::uniform_real_distribution<double>(0, most)(random_); }

  static double radius() { return std::hypot(0.2, 0.1) + std::hypot(0.3, 0.2); }

  Footprint anywhere() {
    Footprint out = box(within(kEdge), within(kEdge));
    out.hx = 0.05 + within(1);
    out.model = 1000;
    return out;
  }
  static double distance(const Footprint& f, double x, double y) {
    return std::hypot(f.x - x, f.y - y) - radiusOf(f);
  }
  static bool boxIsNear(const Footprint& f, double x, double y, double reach) {
    return std::abs(f.x - x) < f.hx + reach && std::abs(f.y - y) < f.hy + reach;
  }

  Fleet fleet_;
  Obstacles obstacles_;
  std::mt19937 random_;
  std::vector<int> things_;
  int met_ = 0;
};

/// Scans of fans of all kinds, at a height at which a body hides the rest, and one at which not.
void scanAround(int robots, const std::vector<Footprint>& parts) {
  const RayFan fans[] = {fanOf(20, -M_PI / 2, M_PI / 2), fanOf(31, -1, 1),  fanOf(1, 0.3, 0.3),
                         fanOf(45, -M_PI, M_PI),         fanOf(9, -3, 2.5), fanOf(7, 0.5, 1.2)};
  BusyFloor floor(robots, 5, parts);
  for (int turn = 0; turn < kTurns; ++turn, floor.turn()) {
    for (const RayFan& fan : fans) floor.scan(fan, turn % 2 ? 0.2 : 0.7);
  }
  EXPECT_GT(floor.met(), 100 * robots);
}

void lookAround(int robots) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    BusyFloor floor(robots, seed);
    for (int turn = 0; turn < kTurns; ++turn, floor.turn()) {
      for (int look = 0; look < kLooks; ++look) floor.look();
    }
  }
}

TEST(Obstacles, AskForWhatIsNearAmongFewRobots) { lookAround(8); }
TEST(Obstacles, AskForWhatIsNearAmongMany) { lookAround(80); }
TEST(Obstacles, ScanLikeSingleRays) { scanAround(8, kTwoBoxes); }
TEST(Obstacles, ScanBodiesThatHideTheirParts) { scanAround(8, bodyWithParts()); }
TEST(Obstacles, ScanAmongManyThatOverlap) { scanAround(40, bodyWithParts()); }

}  // namespace
}  // namespace kiva
