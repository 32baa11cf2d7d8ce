// SPDX-License-Identifier: Apache-2.0
//
// Closed-form mechanics of bodies that are pushed, loaded and hit.
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr double kGravity = 9.81;  // [m/s²]

/// A box whose three moments differ, weightless.
const char* const kBox =
    "<sdf version='1.9'><model name='m'><link name='body'><gravity>false</gravity><inertial>"
    "<mass>10</mass><inertia><ixx>0.3</ixx><iyy>0.5</iyy><izz>0.7</izz></inertia></inertial>"
    "</link></model></sdf>";

/// Returns the angular momentum about the centre of mass, in world [Nms].
Vector3 angularMomentum(const World& world, const std::string& model) {
  const EntityState state = *world.state(model);
  const Vector3 turning = state.pose.Rot().RotateVectorReverse(state.twist.angular);
  return state.pose.Rot().RotateVector(Vector3(0.3, 0.5, 0.7) * turning);
}

TEST(Momentum, ATorqueAndAForceAtACornerGiveWhatTheyAmountTo) {
  Warehouse w;
  w.spawnText(kBox, "box", 0, 0, 0.5, 5);
  const Vector3 force(3, -2, 4), torque(0.2, 0.5, -0.3), corner(0.25, 0.15, -0.1);
  const Vector3 moment = torque + corner.Cross(force);
  const double seconds = 0.5;
  for (int step = 0; step < 500; ++step) {
    w.world.applyWrench("box", "body", force, moment);
    w.step();
  }
  const Vector3 gained = angularMomentum(w.world, "box");
  EXPECT_LT((gained - moment * seconds).Length(), 0.002 * gained.Length());
  EXPECT_LT((w.world.state("box")->twist.linear - force * (seconds / 10)).Length(), 1e-6);
  // Free, it tumbles on with that momentum.
  w.run(1);
  EXPECT_LT((angularMomentum(w.world, "box") - gained).Length(), 0.002 * gained.Length());
}

/// A cart whose centre of mass lies aside: two round wheels at x = 0, a ball at x = -0.4.
TEST(Momentum, WheelsBearWhatTheCentreOfMassLaysOnThem) {
  const auto wheel = [](const std::string& name, const std::string& y) {
    return "<link name='" + name + "'><pose>0 " + y +
           " 0.1 1.5707963 0 "
           "0</pose><inertial><mass>1</mass><inertia><ixx>.004</ixx><iyy>.004</iyy>"
           "<izz>.004</izz></inertia></inertial><collision name='tyre'><geometry><sphere><radius>"
           "0.1</radius></sphere></geometry></collision></link><joint "
           "name='" +
           name + "_joint' type='revolute'><parent>body</parent><child>" + name +
           "</child><axis><xyz>0 0 1</xyz></axis></joint>";
  };
  const std::string cart =
      "<sdf version='1.9'><model name='m'><link name='body'><inertial><pose>-0.1 0.05 0.2 0 0 0"
      "</pose><mass>40</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
      "<collision name='ball'><pose>-0.4 0 0.05 0 0 0</pose><geometry><sphere><radius>0.05</radius>"
      "</sphere></geometry></collision></link>" +
      wheel("left", "0.25") + wheel("right", "-0.25") + "</model></sdf>";
  Warehouse w;
  w.spawnText(cart, "cart", 0, 0);
  w.run(1);
  std::map<std::string, double> load;
  for (const ContactPoint& point : w.world.contacts("cart")) {
    load[point.collision1.substr(6, point.collision1.find("::", 6) - 6)] += point.force.Z();
  }
  EXPECT_NEAR(load["body"] + load["left"] + load["right"], 42 * kGravity, 0.1);
  EXPECT_NEAR(load["body"], 40 * kGravity * 0.1 / 0.4, 0.1);
  const double wheels = 42 * kGravity - load["body"], aside = 40 * kGravity * 0.05 / 0.5;
  EXPECT_NEAR(load["left"], wheels / 2 + aside, 0.2);
  EXPECT_NEAR(load["right"], wheels / 2 - aside, 0.2);
}

}  // namespace
}  // namespace kiva::test
