// SPDX-License-Identifier: Apache-2.0
//
// Bodies that overlap when they are spawned or lifted: they part slowly, or stay, and never gain
// energy. OVERLAPS sets the number of random scenes.
#include <algorithm>
#include <cstdlib>
#include <random>

#include "kiva_plugin_cpp/principal_inertia.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr double kGravity = 9.81;       // [m/s²]
constexpr double kTolerance = 2;        // [J]
constexpr double kMaxRobotSpeed = 1.5;  // [m/s]: what falls on a robot may push it aside

std::string boxText(const Vector3& size, bool is_static, double mass) {
  const std::string s = number(size.X()) + " " + number(size.Y()) + " " + number(size.Z());
  const auto moment = [&](double a, double b) { return number(mass / 12 * (a * a + b * b)); };
  return "<sdf version='1.9'><model name='m'><static>" + std::string(is_static ? "1" : "0") +
         "</static><link name='l'><inertial><mass>" + number(mass) + "</mass><inertia><ixx>" +
         moment(size.Y(), size.Z()) + "</ixx><iyy>" + moment(size.X(), size.Z()) + "</iyy><izz>" +
         moment(size.X(), size.Y()) +
         "</izz></inertia></inertial><collision name='c'><geometry><box><size>" + s +
         "</size></box></geometry></collision></link></model></sdf>";
}

/// A beam across, with its underside at that height [m].
std::string beamText(double underside) {
  return replaced(boxText({2, 0.2, 0.1}, true, 1), "<link name='l'>",
                  "<link name='l'><pose>0 0 " + number(underside + 0.05) + " 0 0 0</pose>");
}

/// The energy of a world's bodies, and its rate of growth by falling.
struct Energies {
  double kinetic = 0;        // [J]
  double from_falling = 0;   // power of gravity on all that sinks [W]
  double fastest_robot = 0;  // [m/s]
};

class Overlaps : public Warehouse {
 public:
  explicit Overlaps(unsigned seed) : Warehouse(Floorplan{40}), random_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int choice(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

  /// Robots with and without loads, around the origin and closer than they have room.
  void fill() {
    const int robots = 1 + choice(3);
    for (int id = 1; id <= robots; ++id) {
      const double x = id - 2.0, y = choice(2);
      spawn("kiva", "kiva" + std::to_string(id), x, y, kQuarter * choice(4));
      if (choice(2) == 0) continue;
      spawn("storage_unit", "storage_unit" + std::to_string(id), x, y);
      carry(id, id);
    }
    run(3);
    const int others = 2 + choice(4);
    for (int i = 0; i < others; ++i) add("other" + std::to_string(i));
  }

  Energies energies() const {
    Energies e;
    const Fleet& f = world.fleet();
    for (int i = 0; i < f.size(); ++i) {
      const Robot& r = f.robots[i];
      const double speed2 = f.vx[i] * f.vx[i] + f.vy[i] * f.vy[i];
      e.kinetic += (r.mass + r.load_mass) * speed2 / 2 +
                   (r.inertia + r.load_inertia) * f.yaw_rate[i] * f.yaw_rate[i] / 2;
      e.fastest_robot = std::max(e.fastest_robot, std::sqrt(speed2));
    }
    for (const std::string& name : world.modelNames()) addBody(name, &e);
    return e;
  }

 private:
  void add(const std::string& name) {
    const double x = uniform(-1.5, 1.5), y = uniform(-0.8, 1.8), yaw = uniform(-M_PI, M_PI);
    switch (choice(6)) {
      case 0:
        return spawn("storage_unit", "storage_unit" + std::to_string(10 + units_++), x, y, yaw);
      case 1:
        return spawn("conveyor_belt", "conveyor_belt" + std::to_string(1 + belts_++), x, y, yaw);
      case 2:
        return spawnText(
            boxText({uniform(0.1, 1), uniform(0.1, 1), uniform(0.1, 1)}, false, uniform(1, 300)),
            name, x, y, yaw, uniform(0, 1.5));
      case 3:
        return spawnText(beamText(uniform(0, 2)), name, x, y, yaw);
      case 4:
        return spawnText(boxText({uniform(0.1, 1), uniform(0.1, 1), uniform(0.1, 2)}, true, 1),
                         name, x, y, yaw, uniform(0, 1));
      default:
        return spawn("kiva", "kiva" + std::to_string(20 + robots_++), x, y, yaw);
    }
  }

  /// A body that is no robot, nor carried by one.
  void addBody(const std::string& name, Energies* e) const {
    const auto description = world.description(name);
    const ModelKind kind = world.kind(name);
    if (description->is_static || kind == ModelKind::kRobot) return;
    const bool is_unit = kind == ModelKind::kStorageUnit;
    if (is_unit && carrierOf(std::stoi(name.substr(12))) != 0) return;
    const Link& link = description->links.front();
    const EntityState state = *world.state(name);
    const Pose mass_frame = state.pose * link.pose_in_model * link.inertial_pose_in_link;
    const Vector3 velocity =
        state.twist.linear + state.twist.angular.Cross(mass_frame.Pos() - state.pose.Pos());
    const Vector3 turn = mass_frame.Rot().RotateVectorReverse(state.twist.angular);
    e->kinetic +=
        link.mass * velocity.SquaredLength() / 2 + (turn * turn * link.principal_moments).Sum() / 2;
    e->from_falling += link.mass * kGravity * std::max(0.0, -velocity.Z());
  }

  std::mt19937 random_;
  int units_ = 0, belts_ = 0, robots_ = 0;
};

int sceneCount() {
  const char* count = std::getenv("OVERLAPS");
  return count ? std::atoi(count) : 60;
}

/// Kinetic energy comes from falling alone. Bodies that are moved apart may be lifted, but not
/// thrown.
TEST(Overlap, GivesNoEnergy) {
  for (int seed = 1; seed <= sceneCount(); ++seed) {
    SCOPED_TRACE("scene " + std::to_string(seed));
    Overlaps w(seed);
    w.fill();
    const double began = w.energies().kinetic;
    double fallen = 0, excess = 0, fastest_robot = 0;  // [J, J, m/s]
    for (int i = 0; i < 2000; ++i) {
      w.step();
      const Energies now = w.energies();
      fallen += now.from_falling * w.world.stepSize();
      excess = std::max(excess, now.kinetic - began - 1.05 * fallen);
      fastest_robot = std::max(fastest_robot, now.fastest_robot);
    }
    EXPECT_LT(excess, kTolerance);
    EXPECT_LT(fastest_robot, kMaxRobotSpeed);
  }
}

/// A person walks into robots that stand in each other, and pushes them as fast as a person walks.
TEST(Overlap, WithAPersonAmongRobotsThrowsNone) {
  Floorplan plan{40};
  plan.options.always_in_bullet = true;
  Warehouse w(plan);
  for (int id = 1; id <= 3; ++id) w.spawn("kiva", "kiva" + std::to_string(id), 0.3 * id, 0.2 * id);
  w.spawn("person", "person1", 0.5, 0.3);
  w.world.walk("person1", {{{0, 0, 1.2, 0}, {1, 1, 1.2, 0}}, true});
  w.run(10, [&] {
    for (int id = 1; id <= 3; ++id) EXPECT_LT(w.speed(id), kMostWalkingSpeed);
  });
}

/// A beam above a unit, whatever the room between them.
TEST(Overlap, OfALoadWithABeamAboveMovesNothing) {
  for (double room = -0.03; room < 0.08; room += 0.003) {
    SCOPED_TRACE("room of " + number(room) + " m");
    Warehouse w(Floorplan{40});
    w.spawn("kiva", "kiva1", 0, 0);
    w.spawn("storage_unit", "storage_unit1", 0, 0);
    w.spawnText(beamText(1.80 + room), "beam", 0, 0);
    w.carry(1, 1);
    w.runUntilIdle(1, 20);
    if (room >= 0) w.expectAt(1, 0, 0);  // else they part meanwhile
    const bool has_room = room > 0.0705;
    EXPECT_EQ(w.count(Event::Kind::kLifted), has_room);
    EXPECT_EQ(w.count(Event::Kind::kBlocked), !has_room);
    EXPECT_EQ(w.loadOf(1), has_room);
  }
}

/// Robots that stand in each other are moved apart slowly, without a speed of their own.
TEST(Overlap, OfRobotsEndsSlowly) {
  constexpr double kMostAStep = 0.0005;  // [m]
  for (double apart : {0.0, 0.1, 0.3, 0.5, 0.6}) {
    SCOPED_TRACE("apart by " + number(apart) + " m");
    Floorplan plan{40};
    plan.options.always_in_bullet = true;
    Warehouse w(plan);
    w.spawn("kiva", "kiva1", 0, 0);
    w.spawn("kiva", "kiva2", apart, 0.02);
    PathPoint before[2] = {{w.x(1), w.y(1)}, {w.x(2), w.y(2)}};
    w.run(8, [&] {
      for (int id : {1, 2}) {
        PathPoint& was = before[id - 1];
        EXPECT_LT(std::hypot(w.x(id) - was.x, w.y(id) - was.y), kMostAStep);
        EXPECT_LT(w.speed(id), 1e-6);
        was = {w.x(id), w.y(id)};
      }
    });
    EXPECT_GT(std::hypot(w.x(1) - w.x(2), w.y(1) - w.y(2)), 0.6);
  }
}

}  // namespace
}  // namespace kiva::test
