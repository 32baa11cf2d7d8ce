// SPDX-License-Identifier: Apache-2.0
//
// Storage units that are pushed: they slide on their feet by Coulomb's law, as planar bodies, and
// are whole bodies where they could tip over.
#include "core/state/places/poses.h"
#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr double kGravity = 9.81;  // [m/s²]

std::string unitWithFriction(double friction, double restitution = 0) {
  return replaced(modelText("storage_unit"), "</collision>",
                  "<surface><friction><ode><mu>" + number(friction) +
                      "</mu></ode></friction><bounce><restitution_coefficient>" +
                      number(restitution) +
                      "</restitution_coefficient></bounce></surface></collision>");
}

/// A box of that mass [kg] and size.
std::string boxText(double mass, const std::string& size, bool falls) {
  const std::string inertia = number(mass * 0.02);
  return "<sdf version='1.9'><model name='box'><link name='l'><gravity>" + number(falls) +
         "</gravity><inertial><mass>" + number(mass) + "</mass><inertia><ixx>" + inertia +
         "</ixx><iyy>" + inertia + "</iyy><izz>" + inertia +
         "</izz></inertia></inertial><collision name='c'><geometry><box><size>" + size +
         "</size></box></geometry></collision></link></model></sdf>";
}

class PushedUnit : public ::testing::Test {
 protected:
  const Model& model() { return *insideOf(w.world).models.find("storage_unit1"); }
  /// Gives the unit at the origin that velocity.
  void push(const Vector3& linear, const Vector3& angular) {
    w.world.setState("storage_unit1", {Pose::Zero, {linear, angular}});
  }
  void runUntilOutOfBullet() {
    w.runUntil([&] { return !model().in_physics; }, 5,
               [&] {
                 if (!model().in_physics) return;
                 planar += model().upright;
                 whole += !model().upright;
               });
  }
  double up() { return w.unitPose(1).Rot().ZAxis().Z(); }
  /// Straight at the unit.
  void throwBox(double mass, double z, double speed) {
    w.spawnText(boxText(mass, "0.2 0.9 0.1", false), "box", -1, 0, 0, z);
    w.world.setState("box", {Pose(-1, 0, z, 0, 0, 0), {Vector3(speed, 0, 0), Vector3::Zero}});
  }

  Warehouse w;
  int planar = 0, whole = 0;  // steps
};

TEST_F(PushedUnit, SlidesAsFarAsCoulombSaysAndLeavesBullet) {
  for (const double friction : {0.1, 0.3}) {
    w.spawnText(unitWithFriction(friction), "storage_unit1", 0, 0);
    const double speed = 1.2;
    push(Vector3(0.6 * speed, 0.8 * speed, 0), Vector3::Zero);
    runUntilOutOfBullet();
    const double way = speed * speed / (2 * friction * kGravity);
    const Pose pose = w.unitPose(1);
    EXPECT_NEAR(std::hypot(pose.X(), pose.Y()), way, 0.01 * way) << friction;
    EXPECT_NEAR(std::atan2(pose.Y(), pose.X()), std::atan2(0.8, 0.6), 1e-4) << friction;
    EXPECT_EQ(pose.Z(), 0) << friction;
    EXPECT_LE(whole, 1) << "it never rocked";
    w.world.remove("storage_unit1");
  }
}

TEST_F(PushedUnit, SpinsDownByTheGripOfItsFeet) {
  w.spawnText(unitWithFriction(0.3), "storage_unit1", 0, 0);
  const double rate = 2;
  push(Vector3::Zero, Vector3(0, 0, rate));
  runUntilOutOfBullet();
  // Inertia, mass and legs of the model.
  const double torque = 0.3 * 60 * kGravity * std::hypot(0.38, 0.38);
  const double angle = rate * rate * 6.4 / (2 * torque);
  EXPECT_NEAR(w.unitPose(1).Rot().Yaw(), angle, 0.02 * angle);
  EXPECT_LT(w.unitPose(1).Pos().Length(), kMillimetre);
}

/// Two units on a floor without friction, the first on its way to the second.
struct Encounter {
  explicit Encounter(double aside, double restitution = 0) {
    w.spawnText(unitWithFriction(0, restitution), "storage_unit1", 0, 0);
    w.spawnText(unitWithFriction(0, restitution), "storage_unit2", 1, aside);
    w.world.setState("storage_unit2", {Pose(1, aside, 0, 0, 0, 0), {}});
    w.world.setState("storage_unit1", {Pose::Zero, {Vector3(kSpeed, 0, 0), Vector3::Zero}});
  }
  EntityState unit(int id) { return *w.world.state("storage_unit" + std::to_string(id)); }
  Vector3 momentum() { return (unit(1).twist.linear + unit(2).twist.linear) * kMass; }
  /// About the origin.
  double turning() {
    double sum = 0;
    for (int id : {1, 2}) {
      const EntityState state = unit(id);
      sum += kMass * state.pose.Pos().Cross(state.twist.linear).Z();
      sum += kInertia * state.twist.angular.Z();
    }
    return sum;
  }

  static constexpr double kMass = 60, kInertia = 6.4,
                          kSpeed = 0.5;  // mass and inertia of the model; speed [m/s]
  Warehouse w;
};

TEST(UnitsThatMeet, GoOnTogetherWhereTheyMeetHeadOn) {
  Encounter head_on(0);
  head_on.w.run(1);
  for (int id : {1, 2}) {
    EXPECT_NEAR(head_on.unit(id).twist.linear.X(), Encounter::kSpeed / 2, 1e-4) << id;
    EXPECT_NEAR(head_on.unit(id).twist.angular.Z(), 0, 1e-4) << id;
    EXPECT_EQ(head_on.unit(id).pose.Z(), 0) << id;
  }
  const double apart = head_on.unit(2).pose.X() - head_on.unit(1).pose.X() - 0.8;  // their width
  EXPECT_NEAR(apart, 0, 2e-4);
}

TEST(UnitsThatMeet, PartAsFastAsTheirRestitutionSays) {
  const double restitution = 0.6;
  Encounter bounce(0, restitution);
  bounce.w.run(1);
  const double first = bounce.unit(1).twist.linear.X(), second = bounce.unit(2).twist.linear.X();
  EXPECT_NEAR(second - first, restitution * Encounter::kSpeed, 0.01 * Encounter::kSpeed);
  EXPECT_NEAR(first + second, Encounter::kSpeed, 1e-6);
}

TEST(UnitsThatMeet, KeepTheirMomentumWhereOneIsHitAside) {
  Encounter aside(0.5);
  const double turning = aside.turning();
  aside.w.run(1);
  EXPECT_NEAR(aside.momentum().X(), Encounter::kMass * Encounter::kSpeed, 1e-6);
  EXPECT_NEAR(aside.momentum().Y(), 0, 1e-6);
  EXPECT_NEAR(aside.turning(), turning, 0.01);
  // Each is pushed as far beside its centre of mass as the other.
  const double rate = aside.unit(1).twist.angular.Z();
  EXPECT_GT(rate, 0.3);
  EXPECT_NEAR(rate, aside.unit(2).twist.angular.Z(), 1e-3);
}

TEST_F(PushedUnit, PushedSlowlyByALoadItSlidesUpright) {
  w.spawnText(unitWithFriction(0.2), "storage_unit1", 2, 0);
  w.spawn("storage_unit", "storage_unit2", 0, 0);
  w.spawnText(withoutPlugin(kivaText({{"speed", "0.1"}}), "laser"), "kiva1", 0, 0);
  w.carry(1, 2);
  w.runUntilIdle(1);
  w.movx(1, 5);
  w.runUntilIdle(1, 60, [&] {
    planar += model().upright && model().disturbed;
    whole += model().in_physics && !model().upright;
  });
  EXPECT_GT(planar, 0);
  EXPECT_EQ(whole, 0);
  EXPECT_GT(w.unitPose(1).X(), 2.0001);
  EXPECT_EQ(w.unitPose(1).Z(), 0);
  EXPECT_EQ(w.count(Event::Kind::kCollision), 1);
}

TEST_F(PushedUnit, HitHighItTipsOver) {
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  throwBox(40, 1.7, 4);
  double least = 1;
  w.run(3, [&] { least = std::min(least, up()); });
  EXPECT_LT(least, 0.5);
  EXPECT_LT(up(), 0.5) << "it lies";
}

TEST_F(PushedUnit, AHitAboveItsMiddleTipsItFromTheSpeedThatMechanicsSays) {
  // Over the feet at 0.4 m, its mass 1 m up; hit where the feet feel nothing of it (centre of
  // percussion). What hits it goes on with it.
  constexpr double kMass = 60, kHeight = 1, kReach = 0.4, kBox = 2;
  constexpr double kInertia = 16 + kMass * (kHeight * kHeight + kReach * kReach);
  constexpr double kHit = kInertia / (kMass * kHeight);
  const double rise = std::hypot(kHeight, kReach) - kHeight;
  const double rate = std::sqrt(2 * kMass * kGravity * rise / kInertia);
  const double speed = (kInertia + kBox * kHit * kHit) * rate / (kBox * kHit);
  for (const double share : {0.93, 1.07}) {
    w.spawn("storage_unit", "storage_unit1", 0, 0);
    throwBox(kBox, kHit, share * speed);
    double least = 1;
    w.run(4, [&] { least = std::min(least, up()); });
    EXPECT_LT(least, 0.98) << share << ": it leans";
    EXPECT_EQ(up() < 0.5, share > 1) << share;
    w.world.remove("storage_unit1");
    w.world.remove("box");
  }
}

TEST_F(PushedUnit, WithTheFloorsGripItRocksWhereItsMassIsHigh) {
  // The floor's friction at its feet acts 1 m below its centre of mass, and they reach 0.4 m.
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  push(Vector3(1, 0, 0), Vector3::Zero);
  double least = 1;
  w.run(2, [&] { least = std::min(least, up()); });
  EXPECT_LT(least, std::cos(0.01));
  EXPECT_GT(up(), 0.9999) << "it fell back on its feet";
}

TEST_F(PushedUnit, ABoxOnItStaysThere) {
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  w.spawnText(boxText(20, "0.5 0.5 0.3", true), "box", 0, 0, 0, 2.2);
  w.run(3);
  EXPECT_NEAR(w.world.state("box")->pose.Z(), 1.8 + 0.15, 0.002);
  push(Vector3(0.3, 0, 0), Vector3::Zero);
  w.run(2);
  EXPECT_NEAR(w.world.state("box")->pose.Z(), 1.8 + 0.15, 0.01);
  EXPECT_GT(up(), 0.9999);
}

/// A loaded robot that drives into a row of units.
struct PushedRow {
  PushedRow() {
    w.spawn("storage_unit", "storage_unit1", 0, 0);
    for (int i = 2; i <= 4; ++i) {
      w.spawnText(unitWithFriction(0.4), "storage_unit" + std::to_string(i), 2.0 + i, 0.1 * i);
    }
    w.spawnText(withoutPlugin(modelText("kiva"), "laser"), "kiva1", 0, 0);
    w.carry(1, 1);
    w.runUntilIdle(1);
    w.movx(1, 10);
  }
  const Model& unit(int id) {
    return *insideOf(w.world).models.find("storage_unit" + std::to_string(id));
  }
  bool slides() {
    const bool is = unit(2).upright && unit(2).disturbed;
    return is && modelState(insideOf(w.world).view, unit(2)).twist.linear.Length() > 0.1;
  }
  Warehouse w;
};

TEST(PushedUnits, GoOnBitByBitFromACheckpoint) {
  PushedRow saved, restored, again;
  saved.w.runUntil([&] { return saved.slides(); }, 20);
  restored.w.world.restore(saved.w.world.checkpoint());
  for (int i = 0; i < 4000; ++i) {
    saved.w.step();
    restored.w.step();
    if (i % 100 == 0) {
      ASSERT_EQ(saved.w.world.stateHash(), restored.w.world.stateHash()) << i;
    }
  }
  again.w.runUntil([&] { return again.slides(); }, 20);
  again.w.run(4);
  EXPECT_EQ(again.w.world.stateHash(), saved.w.world.stateHash());
  EXPECT_GT(saved.w.unitPose(2).X(), 4.05);
  EXPECT_NEAR(saved.w.unitPose(2).Z(), 0, kMillimetre);
}

// --- a robot that drives into something

/// A box of that mass and friction that stands in the way, its centre of mass at the height of the
/// robot's push.
std::string boxInTheWay(double mass, double friction) {
  const std::string m = number(mass), moment = number(mass * 0.4 * 0.4 / 6), mu = number(friction);
  return "<sdf version='1.9'><model name='box'><link name='l'><pose>0 0 0.2 0 0 0</pose><inertial>"
         "<mass>" +
         m + "</mass><inertia><ixx>" + moment + "</ixx><iyy>" + moment + "</iyy><izz>" + moment +
         "</izz></inertia></inertial><collision name='c'><geometry><box><size>0.4 0.4 0.4"
         "</size></box></geometry><surface><friction><ode><mu>" +
         mu + "</mu><mu2>" + mu +
         "</mu2></ode></friction></surface></collision></link></model></sdf>";
}

/// Momentum is shared, less what the floor takes in the steps of the impact.
TEST(RobotThatHitsABox, SharesItsMomentum) {
  for (double mass : {50.0, 145.0, 500.0}) {
    for (double friction : {0.0, 0.5}) {
      SCOPED_TRACE(number(mass) + " kg, friction " + number(friction));
      Warehouse w(Floorplan{60});
      w.spawnText(withoutPlugin(kivaText(), "laser"), "kiva1", 0, 0);
      w.spawnText(boxInTheWay(mass, friction), "box", 4, 0);
      w.movx(1, 20);
      const auto speed = [&] { return w.world.state("box")->twist.linear.X(); };
      double fastest = 0;
      w.run(4, [&] { fastest = std::max(fastest, speed()); });
      const double own = w.robot(1).mass, expected = own * 1.5 / (own + mass);
      EXPECT_LT(fastest, 1.03 * expected);
      const double steps = 0.008;  // [s] from the first touch until both are as fast
      EXPECT_GT(fastest, 0.99 * expected - friction * 9.81 * steps);
    }
  }
}

}  // namespace
}  // namespace kiva::test
