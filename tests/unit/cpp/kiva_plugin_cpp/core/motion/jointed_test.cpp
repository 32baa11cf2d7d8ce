// SPDX-License-Identifier: Apache-2.0
//
// The jointed drive: exact to the millimetre, correct in statics and friction, equal to Bullet's
// own hinges, and affected by bodies in Bullet.
#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr double kGravity = 9.81;  // [m/s²]
constexpr double kMass = 145;      // of robot without load [kg]
constexpr double kCentre = (130 * 0.16 + 2 * 2.5 * 0.1 + 10 * 0.38) / kMass;  // its height [m]
constexpr double kCasters = 0.30;                                             // from the axle [m]
constexpr double kCasterGap = 0.001;                                          // [m]

std::string jointedKiva(Changes changes = {}) {
  changes.push_back({"drive", "jointed"});
  return kivaText(changes);
}

/// One jointed robot, with `load` kg on it if that is positive.
struct Lone {
  explicit Lone(double load = 0, const Changes& changes = {}) {
    w.spawnText(jointedKiva(changes), "kiva1", 0, 0);
    if (load <= 0) return;
    w.spawnText(unitOfMass(load), "storage_unit1", 0, 0);
    w.carry(1, 1);
    w.runUntilIdle(1);
    w.forget();
  }
  const Stance& stance() const { return w.world.fleet().stance[w.index(1)]; }
  Warehouse w;
};

class JointedWithLoad : public ::testing::TestWithParam<double> {};

TEST_P(JointedWithLoad, StopsWithinAMillimetreAndAHundredthDegree) {
  Lone lone(GetParam());
  Warehouse& w = lone.w;
  w.movx(1, 2);
  w.runUntilIdle(1);
  w.expectAt(1, 2, 0);
  for (int turn = 1; turn <= 4; ++turn) {
    w.rot(1, kLeft);
    w.runUntilIdle(1);
    EXPECT_NEAR(w.yaw(1), turn * kQuarter, kHundredthDegree);
    w.expectAt(1, 2, 0);
  }
  w.mov(1, -3, 4);
  w.runUntilIdle(1);
  w.run(5);
  w.expectAt(1, -3, 4);
  w.expectOnGrid(1);
  EXPECT_EQ(w.count(Event::Kind::kDone), 6);
}

TEST(Jointed, KeepsItsLoadAboveTheSameSpotWhileTurning) {
  Lone lone(450);
  lone.w.rot(1, kRight);
  double corner = 0;
  lone.w.runUntilIdle(1, 10, [&] {
    corner = std::max(corner, std::hypot(lone.w.unitPose(1).X(), lone.w.unitPose(1).Y()));
  });
  EXPECT_LT(corner, kMillimetre);
}

TEST_P(JointedWithLoad, RestsUnmovedAndAsleep) {
  Lone lone(GetParam());
  lone.w.movx(1, 1);
  lone.w.runUntilIdle(1);
  lone.w.run(0.5);
  EXPECT_EQ(insideOf(lone.w.world).fleet.awake[0], 0);
  const double x = lone.w.x(1), pitch = lone.stance().pitch;
  lone.w.run(10);
  EXPECT_EQ(lone.w.x(1), x);
  EXPECT_EQ(lone.stance().pitch, pitch);
}
INSTANTIATE_TEST_SUITE_P(Loads, JointedWithLoad, ::testing::Values(0.0, 450.0));

TEST(Jointed, TurnsBeneathAUnitWithoutTouchingIt) {
  Lone lone;
  Warehouse& w = lone.w;
  w.spawn("storage_unit", "storage_unit1", 2, 0);  // 1.2 cm to the legs at the corners
  w.movx(1, 2);
  w.runUntilIdle(1);
  for (int turn = 0; turn < 4; ++turn) {
    w.rot(1, kLeft);
    w.runUntilIdle(1);
  }
  w.movx(1, 2);
  w.runUntilIdle(1);
  w.expectAt(1, 4, 0);
  EXPECT_EQ(w.count(Event::Kind::kCollision), 0);
  EXPECT_EQ(w.count(Event::Kind::kDone), 6);
}

TEST(Jointed, LeansOnTheRearCasterWhenItDrivesOffAndOnTheFrontOneWhenItBrakes) {
  Lone lone;
  const double lean = std::asin(kCasterGap / kCasters);
  lone.w.movx(1, 4);
  lone.w.run(1);
  EXPECT_NEAR(lone.stance().pitch, -lean, 2e-5);
  lone.w.runUntilIdle(1);
  EXPECT_NEAR(lone.stance().pitch, lean, 2e-5);
  EXPECT_NEAR(lone.stance().roll, 0, 1e-9);
  EXPECT_NEAR(lone.stance().height, 0, 1e-6);
}

/// Acceleration [m/s²] once it leans on its rear caster.
double speedingUp(Warehouse& w) {
  w.movx(1, 20);
  w.run(0.3);
  const double before = w.speed(1);
  w.run(0.1);
  return (w.speed(1) - before) / 0.1;
}

/// A floor plane with that friction.
std::string floorText(double friction) {
  return "<sdf version='1.9'><model name='floor'><static>true</static><link name='l'><collision "
         "name='c'><geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>"
         "<surface><friction><ode><mu>" +
         number(friction) + "</mu><mu2>" + number(friction) +
         "</mu2></ode></friction></surface></collision></link></model></sdf>";
}

TEST(Jointed, SpeedsUpOnIceAsWeightAndLeverAllow) {
  // The casters' springs carry their share. The stop of the rear one carries m a h / l. Casters do
  // not grip.
  const double mu = 0.05, share = 0.8;
  const double expected = mu * share * kGravity / (1 + mu * kCentre / kCasters);
  const std::string light = jointedKiva({{"wheel_inertia", "1e-5"}});
  const std::string icy =
      replaced(light, "<mu>0.8</mu><mu2>0.8</mu2>", "<mu>0.05</mu><mu2>0.05</mu2>");
  Warehouse icy_wheels, icy_floor;
  icy_wheels.spawnText(icy, "kiva1", 0, 0);
  EXPECT_NEAR(speedingUp(icy_wheels), expected, 0.002 * expected);

  ASSERT_TRUE(icy_floor.world.remove("ground_plane"));
  icy_floor.spawnText(floorText(mu), "floor", 0, 0);
  icy_floor.spawnText(light, "kiva1", 0, 0);
  EXPECT_NEAR(speedingUp(icy_floor), expected, 0.002 * expected);
}

TEST(Jointed, SpeedsUpWithWhatTheMotorsGive) {
  // Both motors' force on the mass and the spinning wheels: F = m a + 2 I a / r².
  const double torque = 2, radius = 0.1, inertia = 0.03;
  const double expected = 2 * torque / radius / (kMass + 2 * inertia / (radius * radius));
  Lone lone(0, {{"motor_torque", "2"}});
  EXPECT_NEAR(speedingUp(lone.w), expected, 0.001 * expected);
}

/// The same robot as Bullet's bodies, hinges and contacts, driven by the wheels' speeds.
class HingedRobot {
 public:
  HingedRobot() : physics_({0, 0, -kGravity}) {
    ModelDescription floor = *instance(floorText(1), "floor").description;
    floor_ = physics_.build(floor, Pose::Zero, 0, kFloorGroup, ~0);
    ModelDescription robot = *instance(modelText("kiva"), "robot").description;
    for (Joint& joint : robot.joints) {
      if (joint.kind == Joint::Kind::kPrismatic) joint.kind = Joint::Kind::kFixed;
    }
    robot_ = physics_.build(robot, Pose::Zero, 1, kDynamicGroup, ~0);
    physics_.insert(floor_);
    physics_.insert(robot_);
  }
  ~HingedRobot() {
    physics_.remove(robot_);
    physics_.remove(floor_);
  }

  void step(double left, double right, double dt) {
    const double speeds[2] = {left, right};
    for (int wheel = 0; wheel < 2; ++wheel) {
      // Bullet turns a hinge's parent against its child: forward is negative.
      static_cast<btHingeConstraint&>(*robot_.joints[wheel])
          .enableAngularMotor(true, -speeds[wheel], 1e6);
    }
    for (LinkBody& link : robot_.links) link.body->activate(true);
    physics_.step(dt);
  }
  double x() const { return robot_.links[0].linkPose().getOrigin().x(); }
  double yaw() const {
    const btVector3 ahead = robot_.links[0].linkPose().getBasis().getColumn(0);
    return std::atan2(ahead.y(), ahead.x());
  }

 private:
  Physics physics_;
  ModelBodies floor_, robot_;
};

TEST(Jointed, GoesTheWayOfBulletsHinges) {
  Warehouse w;
  w.spawnText(jointedKiva(), "kiva1", 0, 0);
  HingedRobot hinged;
  const Fleet& f = w.world.fleet();
  const auto follow = [&] {
    hinged.step(f.wheel_speed[0][0], f.wheel_speed[1][0], w.world.stepSize());
  };
  double worst = 0;
  w.movx(1, 10);
  w.runUntilIdle(1, 20, [&] {
    follow();
    worst = std::max(worst, std::abs(hinged.x() - w.x(1)));
  });
  EXPECT_LT(worst, 0.015);  // Bullet's tyres slip a thousandth
  EXPECT_GT(worst, 0) << "the same engine twice?";
  w.rot(1, kLeft);
  w.runUntilIdle(1, 20, follow);
  EXPECT_NEAR(hinged.yaw(), w.yaw(1), 0.01);
}

std::string boxText(double mass) {
  const std::string m = number(mass), moment = number(mass * 0.5 * 0.5 / 6);
  return "<sdf version='1.9'><model name='box'><link name='l'><inertial><mass>" + m +
         "</mass><inertia><ixx>" + moment + "</ixx><iyy>" + moment + "</iyy><izz>" + moment +
         "</izz></inertia></inertial><collision name='c'><geometry><box><size>0.5 0.5 "
         "0.5</size></box></geometry></collision></link></model></sdf>";
}

TEST(Jointed, IsPushedByAHeavyBoxAsFarAsItsLockedWheelsSlide) {
  double pushed[2];
  for (int i = 0; i < 2; ++i) {
    Warehouse w;
    w.spawnText(kivaText({{"drive", i == 0 ? "traction" : "jointed"}}), "kiva1", 0, 0);
    w.spawnText(boxText(400), "box", -1, 0, 0, 0.25);
    w.run(0.1);
    EntityState moving = *w.world.state("box");
    moving.twist.linear.X() = 3;
    w.world.setState("box", moving);
    w.run(3);
    EXPECT_EQ(w.count(Event::Kind::kCollision, "kiva1"), 1);
    EXPECT_LT(w.speed(1), 1e-3);
    EXPECT_NEAR(w.y(1), 0, 0.02);
    EXPECT_LT(w.world.state("box")->pose.X() + 0.25, w.x(1) - 0.38 + 0.002);
    pushed[i] = w.x(1);
    w.mov(1, std::round(w.x(1)) + 1, 0);  // and it still drives
    w.runUntilIdle(1);
    w.expectOnGrid(1);
  }
  EXPECT_GT(pushed[1], 0.05);
  // Pushed along, it leans on its front caster, which does not grip.
  const double leaning = 1 + 0.8 * kCentre / kCasters;
  EXPECT_NEAR(pushed[1], pushed[0] * leaning, 0.1 * pushed[0]);
}

TEST(Jointed, AHundredDriveSquaresAndReturnToTheirPlaces) {
  constexpr int kSide = 10;
  const std::string text = jointedKiva({{"speed", "2"},
                                        {"acceleration", "3.5"},
                                        {"quarter_turn_time", "0.82"},
                                        {"drive_wheel_load", "1"}});  // none left to the casters
  Warehouse w;
  for (int id = 1; id <= kSide * kSide; ++id) {
    w.spawnText(text, "kiva" + std::to_string(id), 3 * (id % kSide) - 15, 3 * (id / kSide) - 15);
  }
  const auto all_idle = [&] {
    for (int id = 1; id <= kSide * kSide; ++id) {
      if (w.status(id) != Status::kIdle) return false;
    }
    return true;
  };
  double took = 0;
  for (int side = 0; side < 4; ++side) {
    for (int id = 1; id <= kSide * kSide; ++id) {
      const double way = side < 2 ? 1 : -1;
      side % 2 ? w.movy(id, way) : w.movx(id, way);
    }
    took += w.runUntil(all_idle);
    for (int id = 1; id <= kSide * kSide; ++id) w.rot(id, kLeft);
    took += w.runUntil(all_idle);
  }
  EXPECT_NEAR(4 / took, 0.5, 0.01) << "mean speed";
  for (int id = 1; id <= kSide * kSide; ++id) {
    w.expectAt(id, 3 * (id % kSide) - 15, 3 * (id / kSide) - 15);
    EXPECT_NEAR(w.yaw(id), 4 * kQuarter, kHundredthDegree);
  }
  EXPECT_EQ(w.count(Event::Kind::kDone), 8 * kSide * kSide);
}

TEST(Jointed, DoesTheSameTwice) {
  std::vector<double> first;
  for (int round = 0; round < 2; ++round) {
    Lone lone(450);
    lone.w.mov(1, 3, -2);
    std::vector<double> way;
    lone.w.runUntilIdle(1, 60, [&] {
      way.insert(way.end(), {lone.w.x(1), lone.w.y(1), lone.w.yaw(1), lone.stance().pitch});
    });
    if (round == 0) first = way;
    EXPECT_EQ(way, first);
  }
}

TEST(Jointed, IsAsItWasAfterAReset) {
  Lone lone(450);
  lone.w.mov(1, 3, -2);
  lone.w.run(2);
  lone.w.world.reset(true);
  lone.w.run(1);
  EXPECT_EQ(lone.w.x(1), 0);
  EXPECT_EQ(lone.stance().pitch, 0);
  lone.w.movx(1, 2);
  lone.w.runUntilIdle(1);
  lone.w.expectAt(1, 2, 0);
}

}  // namespace
}  // namespace kiva::test
