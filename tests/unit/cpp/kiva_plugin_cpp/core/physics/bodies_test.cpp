// SPDX-License-Identifier: Apache-2.0
//
// Models of SDF primitives and joints move by the laws of mechanics: they fall, bounce, slide and
// swing.
#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr double kGravity = 9.81;  // [m/s²]

/// The diagonal of an inertia tensor [kg m²] as SDF, with that mass.
std::string inertial(double mass, double ixx, double iyy, double izz) {
  return "<inertial><mass>" + number(mass) + "</mass><inertia><ixx>" + number(ixx) + "</ixx><iyy>" +
         number(iyy) + "</iyy><izz>" + number(izz) + "</izz></inertia></inertial>";
}

struct SurfaceText {
  double friction = 1;
  double restitution = 0;
};

std::string collision(const std::string& geometry, const SurfaceText& touch = {},
                      const std::string& pose = "0 0 0 0 0 0") {
  return "<collision name='" + std::to_string(geometry.size()) + pose + "'><pose>" + pose +
         "</pose><geometry>" + geometry + "</geometry><surface><friction><ode><mu>" +
         number(touch.friction) + "</mu><mu2>" + number(touch.friction) +
         "</mu2></ode></friction><bounce><restitution_coefficient>" + number(touch.restitution) +
         "</restitution_coefficient></bounce></surface></collision>";
}

std::string link(const std::string& name, const std::string& content,
                 const std::string& pose = "0 0 0 0 0 0") {
  return "<link name='" + name + "'><pose>" + pose + "</pose>" + content + "</link>";
}

std::string model(const std::string& content, bool is_static = false) {
  return "<sdf version='1.9'><model name='m'><static>" + std::string(is_static ? "true" : "false") +
         "</static>" + content + "</model></sdf>";
}

std::string box(double x, double y, double z) {
  return "<box><size>" + number(x) + " " + number(y) + " " + number(z) + "</size></box>";
}

std::string ball(double radius) {
  return "<sphere><radius>" + number(radius) + "</radius></sphere>";
}

/// A 10 kg cube of half a metre.
std::string cube(const SurfaceText& touch = {}) {
  return model(link("body", inertial(10, 0.417, 0.417, 0.417) + collision(box(.5, .5, .5), touch)));
}

class Bodies : public ::testing::Test {
 protected:
  Vector3 position(const std::string& name, const std::string& link = "") {
    return w.world.state(name, link)->pose.Pos();
  }
  Vector3 velocity(const std::string& name) { return w.world.state(name)->twist.linear; }

  Warehouse w;
};

// --- falling

TEST_F(Bodies, ABoxFallsAsGalileoSays) {
  w.spawnText(cube(), "box", 0, 0, 0, 3);
  w.run(0.5);
  EXPECT_NEAR(position("box").Z(), 3 - 0.5 * kGravity * 0.25, 0.005);
  EXPECT_NEAR(velocity("box").Z(), -kGravity * 0.5, 0.01);
}

TEST_F(Bodies, ABoxLandsAndRests) {
  w.spawnText(cube(), "box", 2, 3, 0.4, 1);
  w.run(3);
  const Pose rest = w.world.state("box")->pose;
  EXPECT_NEAR(rest.Z(), 0.25, kMillimetre);
  EXPECT_NEAR(rest.X(), 2, kMillimetre);
  EXPECT_NEAR(rest.Y(), 3, kMillimetre);
  EXPECT_NEAR(rest.Rot().Yaw(), 0.4, 0.001);
  EXPECT_NEAR(rest.Rot().ZAxis().Z(), 1, 1e-5);
  EXPECT_LT(velocity("box").Length(), 1e-3);
  w.run(2);
  EXPECT_LT((position("box") - rest.Pos()).Length(), 1e-4);
}

TEST_F(Bodies, WithoutGravityNothingFalls) {
  const std::string floating =
      replaced(cube(), "<link name='body'>", "<link name='body'><gravity>false</gravity>");
  w.spawnText(floating, "box", 0, 0, 0, 1);
  w.run(1);
  EXPECT_NEAR(position("box").Z(), 1, 1e-9);
}

struct Resting {
  std::string name, geometry, pose;
  double height;  // of its origin at rest [m]
};

class RestingShape : public ::testing::TestWithParam<Resting> {};

TEST_P(RestingShape, RestsAtItsHeight) {
  Warehouse w;
  const Resting& shape = GetParam();
  const std::string body =
      link("body", inertial(5, 0.1, 0.1, 0.1) + collision(shape.geometry, {}, shape.pose));
  w.spawnText(model(body), "body", 0, 0, 0, shape.height + 0.05);
  w.run(3);
  EXPECT_NEAR(w.world.state("body")->pose.Z(), shape.height, kMillimetre);
}

INSTANTIATE_TEST_SUITE_P(
    Primitives, RestingShape,
    ::testing::Values(
        Resting{"Box", box(.6, .4, .2), "0 0 0 0 0 0", 0.1},
        Resting{"BoxOnItsSide", box(.6, .4, .2), "0 0 0 1.5707963 0 0", 0.2},
        Resting{"BoxOffItsOrigin", box(.6, .4, .2), "0 0 0.1 0 0 0", 0.0},
        Resting{"Sphere", ball(.3), "0 0 0 0 0 0", 0.3},
        Resting{"Cylinder", "<cylinder><radius>.3</radius><length>.4</length></cylinder>",
                "0 0 0 0 0 0", 0.2},
        Resting{"CylinderLying", "<cylinder><radius>.3</radius><length>.4</length></cylinder>",
                "0 0 0 1.5707963 0 0", 0.3},
        Resting{"CapsuleLying", "<capsule><radius>.2</radius><length>.6</length></capsule>",
                "0 0 0 0 1.5707963 0", 0.2},
        Resting{"Ellipsoid", "<ellipsoid><radii>.5 .4 .2</radii></ellipsoid>", "0 0 0 0 0 0", 0.2}),
    [](const auto& info) { return info.param.name; });

TEST_F(Bodies, StackedBoxesStand) {
  for (int i = 0; i < 3; ++i)
    w.spawnText(cube(), "box" + std::to_string(i), 0, 0, 0, 0.25 + i / 2.);
  w.run(4);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(position("box" + std::to_string(i)).Z(), 0.25 + i / 2., 3 * kMillimetre);
    EXPECT_NEAR(position("box" + std::to_string(i)).X(), 0, 0.01);
  }
}

// --- bouncing

TEST_F(Bodies, ABallBouncesByTheSmallerRestitution) {
  w.spawnText(model(link("plate", collision(box(2, 2, .2), {1, 1.0}, "0 0 0.1 0 0 0")), true),
              "plate", 0, 0);
  for (double restitution : {0.0, 0.5, 0.8}) {
    const std::string body = inertial(1, .004, .004, .004) + collision(ball(.1), {1, restitution});
    w.spawnText(model(link("ball", body)), "ball", 0, 0, 0, 0.3 + 1);
    w.run(0.46);  // just after the impact
    double highest = 0;
    w.run(0.6, [&] { highest = std::max(highest, position("ball").Z() - 0.3); });
    EXPECT_NEAR(highest, restitution * restitution, 0.05) << restitution;
    w.run(8);
    EXPECT_NEAR(position("ball").Z(), 0.3, kMillimetre) << restitution;
    w.world.remove("ball");
  }
}

TEST_F(Bodies, ABallThatLosesNothingBouncesToItsHeightAgainAndAgain) {
  w.spawnText(model(link("plate", collision(box(2, 2, .2), {1, 1.0}, "0 0 0.1 0 0 0")), true),
              "plate", 0, 0);
  const std::string body = inertial(1, .004, .004, .004) + collision(ball(.1), {1, 1.0});
  w.spawnText(model(link("ball", body)), "ball", 0, 0, 0, 0.3 + 1);
  w.run(18);
  double highest = 0;
  w.run(2, [&] { highest = std::max(highest, position("ball").Z() - 0.3); });
  EXPECT_NEAR(highest, 1, 0.005);
}

// --- rolling

struct Rolling {
  std::string name, geometry, floor;
};

class RollingBody : public ::testing::TestWithParam<Rolling> {
 protected:
  static constexpr double kRadius = 0.2, kHeight = 0.5;
  /// Puts a body on the floor plane, or on a large box of that height, lying along y.
  RollingBody() {
    const bool on_box = GetParam().floor == "box";
    if (on_box)
      w.spawnText(model(link("plate", collision(box(100, 4, kHeight))), true), "plate", 0, 0);
    const double z = kRadius + (on_box ? kHeight / 2 : 0);
    const std::string shape = collision(GetParam().geometry, {}, "0 0 0 1.5707963267948966 0 0");
    w.spawnText(model(link("body", inertial(2, .05, .04, .05) + shape)), "body", -20, 0, 0, z);
  }
  EntityState state() { return *w.world.state("body"); }
  void push(const Vector3& linear, const Vector3& angular) {
    w.world.setState("body", {state().pose, {linear, angular}});
  }
  Warehouse w;
};

TEST_P(RollingBody, RollsOnAtItsSpeed) {
  push({1, 0, 0}, {0, 1 / kRadius, 0});
  w.run(40);
  EXPECT_NEAR(state().twist.linear.X(), 1, 0.001);
  EXPECT_NEAR(state().twist.angular.Y(), 1 / kRadius, 0.005);
  EXPECT_NEAR(state().pose.X(), 20, 0.02);
  EXPECT_NEAR(state().pose.Y(), 0, 0.01);
}

TEST_P(RollingBody, SpinsDownAsCoulombsFrictionAlongALineSays) {
  // An even load m g / l resists by mu m g l / 4.
  const double turn = 1.0 * 2 * kGravity * 0.4 / 4 / .05;
  push({0, 0, 0}, {0, 0, 30});
  w.run(0.5);
  EXPECT_NEAR(state().twist.angular.Z(), 30 - 0.5 * turn, 0.03 * turn);
  w.run(2);
  EXPECT_NEAR(state().twist.angular.Z(), 0, 1e-3);
}
const char* const kCylinder = "<cylinder><radius>.2</radius><length>.4</length></cylinder>";
const char* const kCapsule = "<capsule><radius>.2</radius><length>.4</length></capsule>";
INSTANTIATE_TEST_SUITE_P(Shapes, RollingBody,
                         ::testing::Values(Rolling{"CylinderOnThePlane", kCylinder, "plane"},
                                           Rolling{"CylinderOnABox", kCylinder, "box"},
                                           Rolling{"CapsuleOnThePlane", kCapsule, "plane"},
                                           Rolling{"CapsuleOnABox", kCapsule, "box"}),
                         [](const auto& info) { return info.param.name; });

TEST_F(Bodies, ACylinderFallsOffTheEdgeOfABox) {
  w.spawnText(model(link("plate", collision(box(2, 4, 1))), true), "plate", 0, 0);
  const std::string shape = collision(kCylinder, {}, "0 0 0 1.5707963267948966 0 0");
  w.spawnText(model(link("body", inertial(2, .05, .04, .05) + shape)), "body", 0, 0, 0, 0.7);
  w.world.setState("body", {Pose(0, 0, 0.7, 0, 0, 0), {{1, 0, 0}, {0, 5, 0}}});
  w.run(0.99);
  EXPECT_NEAR(position("body").Z(), 0.7, kMillimetre);
  w.run(2);
  EXPECT_NEAR(position("body").Z(), 0.2, 0.002);
  EXPECT_GT(position("body").X(), 1.5);
}

// --- friction

class Slope : public Bodies {
 protected:
  /// Puts a cube on a plate that is inclined by `angle` [rad] about y. Returns the distance that it
  /// slides down in `seconds`.
  double slide(double angle, double friction, double seconds, double of_plate = 1) {
    const std::string plate = model(link("plate", collision(box(20, 4, .2), {of_plate, 0})), true);
    w.world.spawn(instance(plate, "plate", Pose(0, 0, 10, 0, angle, 0)));
    const Pose on_plate = Pose(0, 0, 10, 0, angle, 0) * Pose(0, 0, 0.1 + 0.25, 0, 0, 0);
    w.world.spawn(instance(cube({friction, 0}), "box", on_plate));
    w.run(seconds);
    const double way = (position("box") - on_plate.Pos()).Length();
    w.world.remove("box");
    w.world.remove("plate");
    return way;
  }
};

TEST_F(Slope, ABoxHoldsWhereTheTangentIsLessThanItsFriction) {
  EXPECT_LT(slide(std::atan(0.45), 0.5, 3), 2 * kMillimetre);
  EXPECT_LT(slide(std::atan(0.25), 0.3, 3), 2 * kMillimetre);
}

TEST_F(Slope, TheSmallerFrictionCounts) {
  EXPECT_LT(slide(std::atan(0.45), 0.5, 3, 0.5), 2 * kMillimetre);
  const double angle = std::atan(0.7);
  const double expected = 0.5 * kGravity * (std::sin(angle) - 0.2 * std::cos(angle));
  EXPECT_NEAR(slide(angle, 100, 1, 0.2), expected, 0.03 * expected);
}

TEST_F(Slope, ABoxSlidesWithWhatFrictionLeavesOfGravity) {
  for (double friction : {0.0, 0.2, 0.5}) {
    const double angle = std::atan(0.7);
    const double acceleration = kGravity * (std::sin(angle) - friction * std::cos(angle));
    const double expected = 0.5 * acceleration * 1;
    EXPECT_NEAR(slide(angle, friction, 1), expected, 0.03 * expected) << friction;
  }
}

// --- forces

TEST_F(Bodies, AForceAcceleratesForOneStep) {
  w.spawnText(cube({0, 0}), "box", 0, 0, 0, 0.25);
  w.run(0.1);
  w.run(0.5, [&] { w.world.applyWrench("box", "body", {20, 0, 0}, {}); });
  EXPECT_NEAR(velocity("box").X(), 20 / 10. * 0.5, 0.01);
  w.run(0.5);
  EXPECT_NEAR(velocity("box").X(), 1, 0.01);
}

TEST_F(Bodies, ABodyFallsAsleepWhereItStandsAndNotWhileItCreeps) {
  w.spawnText(cube({0, 0}), "box", 0, 0, 0, 0.25);
  w.spawnText(cube(), "resting_box", 5, 0, 0, 0.25);
  w.world.setState("box", {Pose(0, 0, 0.25, 0, 0, 0), {{0.05, 0, 0}, {}}});
  w.run(6);
  EXPECT_NEAR(position("box").X(), 0.05 * 6, 0.005);
  EXPECT_FALSE(insideOf(w.world).models.find("resting_box")->bodies.links[0].body->isActive());
}

TEST_F(Bodies, ASleepingBodyWakesWhenPushed) {
  w.spawnText(cube({0.1, 0}), "box", 0, 0, 0, 0.25);
  w.run(6);
  w.run(0.5, [&] { w.world.applyWrench("box", "body", {50, 0, 0}, {}); });
  EXPECT_GT(position("box").X(), 0.1);
}

// --- joints

/// A rod of 1 m and 2 kg that hangs from (0, 0, 3) and turns about y. `joint` is the content of
/// its joint; the rod points down, at 0 rad.
std::string rod(const std::string& joint, const std::string& type = "revolute") {
  const double across = 2. / 12;  // m·l²/12
  return model(link("rod", inertial(2, across, across, 0.001), "0 0 -0.5 0 0 0") +
               "<joint name='j' type='" + type +
               "'><pose>0 0 0.5 0 0 0</pose><parent>world</parent><child>rod</child><axis>"
               "<xyz>0 1 0</xyz>" +
               joint + "</axis></joint>");
}

class Pendulum : public Bodies {
 protected:
  static constexpr double kInertia = 2. / 3;  // about the pivot, m·l²/3 [kg m²]

  void swing(const std::string& text, double angle) {
    w.world.spawn(instance(text, "rod", Pose(0, 0, 3, 0, 0, 0)));
    // The rod's centre goes around the pivot.
    const Pose turned = Pose(0, 0, 3, 0, angle, 0);
    w.world.setState("rod", {turned, {}});
  }
  /// Returns the angle of the rod from hanging down, positive about y [rad].
  double angle() {
    const Vector3 arm = position("rod", "rod") - Vector3(0, 0, 3);
    return std::atan2(-arm.X(), -arm.Z());
  }
  /// Returns the kinetic and potential energy, relative to hanging at rest [J].
  double energy() {
    const EntityState rod = *w.world.state("rod", "rod");
    const double rate = rod.twist.angular.Y();
    return 0.5 * kInertia * rate * rate + 2 * kGravity * 0.5 * (1 - std::cos(angle()));
  }
};

TEST_F(Pendulum, SwingsWithItsPeriod) {
  swing(rod(""), 0.1);
  std::vector<double> crossings;
  double before = angle();
  w.run(8, [&] {
    if (before > 0 && angle() <= 0) crossings.push_back(w.world.time());
    before = angle();
  });
  ASSERT_GE(crossings.size(), 4u);
  const double period = (crossings[3] - crossings[0]) / 3;
  EXPECT_NEAR(period, 2 * M_PI * std::sqrt(kInertia / (2 * kGravity * 0.5)), 0.01);
}

TEST_F(Pendulum, KeepsItsEnergy) {
  swing(rod(""), 1.2);
  const double before = energy();
  double least = before, most = before;
  w.run(10, [&] {
    least = std::min(least, energy());
    most = std::max(most, energy());
  });
  EXPECT_GT(least, 0.95 * before);
  EXPECT_LT(most, 1.05 * before);
}

TEST_F(Pendulum, StaysOnItsPivot) {
  swing(rod(""), 1.5);
  w.run(5, [&] {
    const Pose rod = w.world.state("rod", "rod")->pose;
    const Vector3 top = (rod * Pose(0, 0, 0.5, 0, 0, 0)).Pos();
    EXPECT_LT((top - Vector3(0, 0, 3)).Length(), 2 * kMillimetre);
  });
}

TEST_F(Pendulum, StopsAtItsLimits) {
  const std::string limits = "<limit><lower>-0.3</lower><upper>0.8</upper></limit>";
  for (double side : {1.0, -1.0}) {
    swing(rod(limits), 0);
    w.run(2, [&] { w.world.applyWrench("rod", "rod", {-side * 100, 0, 0}, {}); });
    EXPECT_NEAR(angle(), side > 0 ? 0.8 : -0.3, 0.02);
    w.world.remove("rod");
  }
}

TEST_F(Bodies, AContinuousJointSpinsOn) {
  w.world.spawn(instance(rod("", "continuous"), "rod", Pose(0, 0, 3, 0, 0, 0)));
  w.run(1, [&] { w.world.applyWrench("rod", "rod", {0, 0, 0}, {0, 30, 0}); });
  double turned = 0, before = 0;
  const auto angle = [&] {
    const Vector3 arm = position("rod", "rod") - Vector3(0, 0, 3);
    return std::atan2(-arm.X(), -arm.Z());
  };
  before = angle();
  w.run(2, [&] {
    turned += std::remainder(angle() - before, 2 * M_PI);
    before = angle();
  });
  EXPECT_GT(turned, 4 * M_PI);
}

TEST_F(Bodies, APrismaticJointStopsAtItsLimits) {
  const std::string slider = model(
      link("slide", inertial(2, .1, .1, .1)) +
      "<joint name='j' type='prismatic'><parent>world</parent><child>slide</child><axis><xyz>0 0 "
      "1</xyz><limit><lower>-0.3</lower><upper>0.5</upper></limit></axis></joint>");
  w.spawnText(slider, "slider", 0, 0, 0, 3);
  w.run(2);
  EXPECT_NEAR(position("slider", "slide").Z(), 2.7, 2 * kMillimetre);
  w.run(2, [&] { w.world.applyWrench("slider", "slide", {5, 5, 60}, {}); });
  EXPECT_NEAR(position("slider", "slide").Z(), 3.5, 5 * kMillimetre);
  EXPECT_NEAR(position("slider", "slide").X(), 0, 2 * kMillimetre);
}

TEST_F(Bodies, APrismaticJointSlidesFreelyBetween) {
  const std::string slider =
      model(link("slide", inertial(2, .1, .1, .1)) +
            "<joint name='j' type='prismatic'><parent>world</parent><child>slide</child><axis>"
            "<xyz>1 0 1</xyz></axis></joint>");
  w.spawnText(slider, "slider", 0, 0, 0, 10);
  w.run(1);
  // Along a line inclined by 45°, with the component of gravity along it.
  const double way = 0.5 * kGravity * M_SQRT1_2 * 1;
  EXPECT_NEAR(position("slider", "slide").Z(), 10 - way * M_SQRT1_2, 0.02);
  EXPECT_NEAR(position("slider", "slide").X(), -way * M_SQRT1_2, 0.02);
}

TEST_F(Bodies, AFixedJointKeepsTwoLinksTogether) {
  const std::string part = inertial(5, .1, .1, .1) + collision(box(.2, .2, .2));
  w.spawnText(model(link("a", part) + link("b", part, "0.5 0 0.1 0 0 0") +
                    "<joint name='j' type='fixed'><parent>a</parent><child>b</child></joint>"),
              "pair", 0, 0, 0, 1);
  const auto between = [&] {
    return w.world.state("pair", "a")->pose.Inverse() * w.world.state("pair", "b")->pose;
  };
  double shift = 0;
  w.run(3, [&] { shift = std::max(shift, (between().Pos() - Vector3(0.5, 0, 0.1)).Length()); });
  EXPECT_LT(shift, 5 * kMillimetre);
  EXPECT_LT((between().Pos() - Vector3(0.5, 0, 0.1)).Length(), kMillimetre);
  EXPECT_LT(position("pair", "a").Z(), 0.3);
}

TEST_F(Bodies, AResetPutsJointsBack) {
  const std::string part = inertial(1, .01, .01, .01) + collision(box(.3, .1, .1));
  w.spawnText(model(link("a", part) + link("b", part, "0.4 0 0 0 0 0") +
                    "<joint name='j' type='revolute'><pose>-0.2 0 0 0 0 0</pose><parent>a</parent>"
                    "<child>b</child><axis><xyz>0 1 0</xyz></axis></joint>"),
              "hinge", 0, 0, 0, 1);
  w.run(0.2, [&] { w.world.applyWrench("hinge", "b", {}, {0, 0.5, 0}); });
  const auto bend = [&] {
    return (w.world.state("hinge", "a")->pose.Inverse() * w.world.state("hinge", "b")->pose)
        .Rot()
        .Euler()
        .Y();
  };
  ASSERT_GT(std::abs(bend()), 0.1);
  w.world.reset(true);
  EXPECT_NEAR(bend(), 0, 1e-9);
  EXPECT_NEAR(position("hinge").Z(), 1, 1e-9);
  w.run(0.1);
  EXPECT_NEAR(bend(), 0, 0.01);  // and it falls as it did at first
}

}  // namespace
}  // namespace kiva::test
