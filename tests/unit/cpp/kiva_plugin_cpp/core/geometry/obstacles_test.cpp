// SPDX-License-Identifier: Apache-2.0
//
// Queries around a point: each obstacle that is near enough is visited once, however models and
// robots were added, moved and removed.
#include "core/geometry/obstacles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace kiva {
namespace {

constexpr double kEdge = 12;       // of the floor [m]
constexpr double kMargin = 0.005;  // by which more may be asked for [m]
constexpr int kThings = 150, kTurns = 20, kLooks = 25;

class BusyFloor {
 public:
  BusyFloor(int robots, unsigned seed) : obstacles_(fleet_), random_(seed) {
    for (int i = 0; i < robots; ++i) {
      for (auto* column : {&fleet_.x, &fleet_.y, &fleet_.yaw}) column->push_back(within(kEdge));
      obstacles_.setMover(i, {box(0, 0), box(0.2, 0.1)});
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
    std::map<const Footprint*, int> things;
    std::map<int, int> robots;
    const auto meets = [&](const Footprint& thing) { return ++things[&thing] == 0; };
    const auto approaches = [&](int robot, double) { return ++robots[robot] == 0; };
    EXPECT_FALSE(obstacles_.anyAround(x, y, reach, far, meets, approaches));
    for (const int thing : things_) {
      const Footprint& f = obstacles_[thing];
      const bool is_within = std::hypot(f.x - x, f.y - y) < reach + radiusOf(f);
      const bool touches = is_within && boxIsNear(f, x, y, reach);
      const int asked = things[&f];
      EXPECT_LE(asked, 1);
      if (touches) {
        EXPECT_EQ(asked, 1);
      } else if (asked) {
        EXPECT_LE(distance(f, x, y), reach + kMargin);
      }
    }
    for (std::size_t i = 0; i < fleet_.x.size(); ++i) {
      const double away = std::hypot(fleet_.x[i] - x, fleet_.y[i] - y);
      EXPECT_EQ(robots[static_cast<int>(i)], away < far + radius() ? 1 : 0);
    }
  }

 private:
  double within(double most) { return std::uniform_real_distribution<double>(0, most)(random_); }

  static Footprint box(double x, double y) {
    Footprint out;
    out.x = x;
    out.y = y;
    out.hx = 0.3;
    out.hy = 0.2;
    return out;
  }
  static double radius() { return std::hypot(0.2, 0.1) + std::hypot(0.3, 0.2); }

  Footprint anywhere() {
    Footprint out = box(within(kEdge), within(kEdge));
    out.hx = 0.05 + within(1);
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
};

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

}  // namespace
}  // namespace kiva
