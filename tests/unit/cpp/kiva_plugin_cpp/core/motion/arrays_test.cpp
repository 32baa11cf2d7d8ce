// SPDX-License-Identifier: Apache-2.0
//
// Robots that nothing can touch are stepped in arrays, with the same motion as in Bullet.
#include <map>
#include <random>

#include "core/motion/driving/clearance.h"
#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr int kRobots = 8;
constexpr int kCommands = 200;

/// Robots with a unit each, in lanes of their own, and the commands they get.
class Lanes {
 public:
  explicit Lanes(bool always_in_bullet) : w(plan(always_in_bullet)) {
    for (int id = 1; id <= kRobots; ++id) {
      const double y = 8 * id - 36;
      w.spawn("kiva", "kiva" + std::to_string(id), 0, y);
      w.spawn("storage_unit", "storage_unit" + std::to_string(id), 2, y);
    }
  }

  /// The next random command, for any robot, sensible or not.
  void command() {
    const int id = uniform(1, kRobots);
    switch (uniform(0, 5)) {
      case 0:
        return w.rot(id, uniform(0, 1) ? 1 : -1);
      case 1:
        return w.movx(id, uniform(-3, 3));
      case 2:
        return w.movy(id, uniform(-1, 1));
      case 3:
        return w.mov(id, 2, 8 * id - 36);  // to where its unit was first
      case 4:
        return w.carry(id, id);
      default:
        return w.drop(id, id);
    }
  }

  int cruising() const {
    const auto& mask = insideOf(w.world).fleet.cruising;
    return static_cast<int>(mask.size() - std::count(mask.begin(), mask.end(), 0));
  }

  Warehouse w;

 private:
  static Floorplan plan(bool always_in_bullet) {
    Floorplan plan;
    plan.size = 100;
    plan.options.always_in_bullet = always_in_bullet;
    return plan;
  }
  int uniform(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }

  std::mt19937 random_{7};
};

double difference(const Fleet& a, const Fleet& b) {
  double most = 0;
  for (int i = 0; i < a.size(); ++i) {
    most = std::max({most, std::abs(a.x[i] - b.x[i]), std::abs(a.y[i] - b.y[i]),
                     std::abs(a.yaw[i] - b.yaw[i]), std::abs(a.tower[i] - b.tower[i])});
  }
  return most;
}

TEST(Arrays, MoveAFleetAsBulletDoes) {
  Lanes arrays(false), bullet(true);
  double most = 0;
  int cruised = 0;
  for (int k = 0; k < kCommands; ++k) {
    arrays.command();
    bullet.command();
    arrays.w.run(0.5, [&] {
      bullet.w.step();
      most = std::max(most, difference(arrays.w.world.fleet(), bullet.w.world.fleet()));
      cruised += arrays.cruising();
      ASSERT_EQ(bullet.cruising(), 0);
    });
  }
  EXPECT_LT(most, 1e-9);
  EXPECT_GT(cruised, 10000) << "the arrays were hardly used";
  ASSERT_EQ(arrays.w.events.size(), bullet.w.events.size());
  for (std::size_t k = 0; k < arrays.w.events.size(); ++k) {
    const Event &a = arrays.w.events[k], &b = bullet.w.events[k];
    EXPECT_EQ(a.time, b.time) << a.model << ": " << a.text;
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.model, b.model);
    EXPECT_EQ(a.text, b.text);
  }
  EXPECT_GT(arrays.w.count(Event::Kind::kDone), kCommands / 4);
  EXPECT_GT(arrays.w.count(Event::Kind::kLifted), 3);
}

TEST(Arrays, CruiseWhileTheySpeedUpBrakeAndTurn) {
  for (const bool loaded : {false, true}) {
    Warehouse w;
    w.spawn("kiva", "kiva1", 0, 0);
    if (loaded) {
      w.spawnText(unitOfMass(300), "storage_unit1", 0, 0);
      w.carry(1, 1);
      w.runUntilIdle(1);
    }
    const auto& cruising = insideOf(w.world).fleet.cruising;
    const auto share = [&](double seconds) {
      int steps = 0, cruised = 0;
      w.run(seconds, [&] {
        ++steps;
        cruised += cruising[0] != 0;
      });
      return static_cast<double>(cruised) / steps;
    };
    w.rot(1, kLeft);
    EXPECT_GT(share(0.6), 0.9) << "turning";
    w.runUntilIdle(1);
    EXPECT_NEAR(w.yaw(1), kQuarter, 1e-9);
    w.movy(1, 3);
    EXPECT_GT(share(1.4), 0.9) << "speeding up";
    EXPECT_GT(share(1.8), 0.9) << "braking";
    w.runUntilIdle(1);
    EXPECT_NEAR(w.y(1), 3, 1e-9);
  }
}

/// Steps that add to coordinates of hundreds of metres leave errors of that size, which to steer
/// back from would take seconds.
TEST(Arrays, CruiseBesideTheLineByARoundingError) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  insideOf(w.world).fleet.y[0] = 5e-10;
  const auto& cruising = insideOf(w.world).fleet.cruising;
  int steps = 0, cruised = 0;
  w.movx(1, 5);
  w.runUntilIdle(1, 120, [&] {
    ++steps;
    cruised += cruising[0] != 0;
  });
  EXPECT_GT(cruised, 0.95 * steps);
  EXPECT_NEAR(w.y(1), 0, 1e-9);
}

/// A loose box of 5 kg.
std::string parcel(double edge) {
  const std::string e = std::to_string(edge), size = e + " " + e + " " + e;
  return "<sdf version='1.9'><model name='parcel'><link name='link'><inertial><mass>5</mass>"
         "<inertia><ixx>0.03</ixx><iyy>0.03</iyy><izz>0.03</izz></inertia></inertial>"
         "<collision name='c'><geometry><box><size>" +
         size + "</size></box></geometry></collision></link></model></sdf>";
}

/// The order of the tests, by which a crowded robot tries short times first, does not change the
/// result.
TEST(Arrays, FindAWayFreeForAsLongHoweverTheyAsk) {
  Floorplan plan;
  plan.size = 12;
  Warehouse w(plan);
  constexpr int kCrowd = 16;
  for (int id = 1; id <= kCrowd; ++id) {
    w.spawn("kiva", "kiva" + std::to_string(id), 2 * (id % 4) - 3, id / 4 * 2 - 4);
  }
  std::mt19937 random(5);
  const auto cells = [&] { return std::uniform_int_distribution<int>(-3, 3)(random); };
  std::map<double, int> by_period;
  for (int round = 0; round < 300; ++round) {
    const int id = round % kCrowd + 1;
    round % 2 ? w.movx(id, cells()) : w.movy(id, cells());
    w.run(0.05);
    const WorldState& world = insideOf(w.world);
    for (int i = 0; i < kCrowd; ++i) {
      const double time = clearTime(world.view, i, false);
      ++by_period[time];
      ASSERT_EQ(clearTime(world.view, i, true), time)
          << "kiva" << i + 1 << " at " << w.world.time();
    }
  }
  EXPECT_GE(by_period.size(), 4u);  // 0, short, longer and long times
  for (const auto& [time, times] : by_period) EXPECT_GT(times, 5) << time;
}

TEST(Arrays, LetGoOfARobotBeforeABoxHitsIt) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.movx(1, 6);
  w.run(2);
  ASSERT_NE(insideOf(w.world).fleet.cruising[0], 0);
  const double ahead = w.x(1) + 0.38 + 0.1;  // nearer than it can stop
  w.spawnText(parcel(0.2), "box", ahead + 0.1, 0, 0, 0.1);
  w.run(0.5);
  EXPECT_EQ(insideOf(w.world).fleet.cruising[0], 0);
  EXPECT_EQ(w.count(Event::Kind::kCollision), 1);
  const auto box = w.world.state("box");
  ASSERT_TRUE(box);
  EXPECT_GT(box->pose.X() - 0.1, w.x(1) + 0.38 - 0.002) << "the robot went into it";
  EXPECT_GT(box->pose.X(), ahead + 0.1) << "it was not pushed";
}

TEST(Arrays, StopForAWallThatIsSpawnedAhead) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.movx(1, 10);
  w.run(3);
  ASSERT_NE(insideOf(w.world).fleet.cruising[0], 0);
  w.spawn("wall", "wall1", std::ceil(w.x(1)) + 3, 0, kQuarter);
  w.runUntilIdle(1);
  EXPECT_EQ(w.count(Event::Kind::kBlocked, "kiva1"), 1);
  EXPECT_EQ(w.count(Event::Kind::kCollision), 0);
  w.expectOnGrid(1);
}

}  // namespace
}  // namespace kiva::test
