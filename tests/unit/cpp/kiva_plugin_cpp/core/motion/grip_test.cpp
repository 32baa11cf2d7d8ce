// SPDX-License-Identifier: Apache-2.0
//
// Friction of the floor, everywhere and in places, and its effect on robots: they plan with the
// floor as built, and reach all goals that way, more slowly.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;

constexpr double kGravity = 9.81;  // [m/s²]
constexpr double kOnWheels = 0.8;  // share of the weight that is on the driven wheels
constexpr double kReserve = 0.9;   // of the grip that plans count on
constexpr double kUnitMass = 180;  // [kg]

std::string surface(double friction) {
  const std::string mu = number(friction);
  return "<surface><friction><ode><mu>" + mu + "</mu><mu2>" + mu +
         "</mu2></ode></friction></surface>";
}

std::string fixed(const std::string& name, const std::string& shape, double friction,
                  const std::string& pose = "0 0 0 0 0 0") {
  return "<model name='" + name + "'><static>1</static><pose>" + pose +
         "</pose><link name='l'><collision name='c'><geometry>" + shape + "</geometry>" +
         surface(friction) + "</collision></link></model>";
}

const char kPlane[] = "<plane><normal>0 0 1</normal><size>100 100</size></plane>";

std::string box(const std::string& size) { return "<box><size>" + size + "</size></box>"; }

/// A warehouse on floors of those models alone, with a grid.
struct GripHall : Warehouse {
  explicit GripHall(const std::string& models)
      : Warehouse(parseWorld("<sdf version='1.9'><world name='w'>" + models +
                                 "<plugin name='grid' filename='libkiva_grid.so'><spacing>1"
                                 "</spacing></plugin></world></sdf>",
                             modelPaths(), "test")) {}

  /// Acceleration of kiva1 as it sets off along x [m/s²].
  double speedingUp() {
    movx(1, 20);
    run(0.1);
    const double before = speed(1);
    run(0.1);
    return (speed(1) - before) / 0.1;
  }
};

using Slippery = ::testing::TestWithParam<std::tuple<const char*, double, bool>>;

/// Turns and drives to the millimetre, as on a dry floor.
TEST_P(Slippery, FloorsAreDrivenSlower) {
  const auto [drive, friction, loaded] = GetParam();
  GripHall hall(fixed("floor", kPlane, friction));
  hall.spawnText(kivaText({{"drive", drive}}), "kiva1", 0, 0);
  if (loaded) {
    hall.spawnText(unitOfMass(kUnitMass), "storage_unit1", 0, 0);
    hall.carry(1, 1);
    hall.runUntilIdle(1);
  }
  hall.forget();
  hall.rot(1, kLeft);
  hall.runUntilIdle(1);
  hall.expectAt(1, 0, 0);
  EXPECT_NEAR(hall.yaw(1), kQuarter, kHundredthDegree);
  hall.movx(1, 2);
  hall.runUntilIdle(1);
  hall.expectAt(1, 2, 0);
  hall.expectOnGrid(1);
  EXPECT_EQ(hall.count(Kind::kDone), 2);
  EXPECT_TRUE(hall.world.takeWarnings().empty());
}

INSTANTIATE_TEST_SUITE_P(All, Slippery,
                         ::testing::Combine(::testing::Values("traction", "jointed"),
                                            ::testing::Values(0.8, 0.3, 0.2, 0.1, 0.05, 0.01),
                                            ::testing::Bool()));

TEST(Grip, ThatIsNoneIsToldOnce) {
  GripHall hall(fixed("floor", kPlane, 0));
  hall.spawn("kiva", "kiva1", 0, 0);
  hall.run(0.1);
  hall.spawn("kiva", "kiva2", 0, 3);
  hall.run(0.1);
  const std::vector<std::string> warnings = hall.world.takeWarnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_PRED2(contains, warnings.front(), "its friction for wheels is 0; below 0.001");
  hall.movx(1, 2);
  hall.runUntilIdle(1);
  EXPECT_EQ(hall.count(Kind::kBlocked, "kiva1"), 1);
}

/// Returns the acceleration of a robot at that place, which its surface limits; the command is 1
/// m/s².
double speedingUpAt(const std::string& models, double x, double y) {
  GripHall hall(models);
  hall.spawn("kiva", "kiva1", x, y);
  return hall.speedingUp();
}

double allowed(double friction) { return kReserve * friction * kOnWheels * kGravity; }

/// Wherever they stand in the file.
TEST(Grip, IsThatOfTheSurfaceWhereARobotStands) {
  const std::string floor = fixed("floor", box("100 100 0.1"), 0.8, "0 0 -0.05 0 0 0");
  const std::string slab = fixed("slab", box("1 1 0.1"), 0.05, "-10 0 -0.05 0 0 0");
  for (const std::string& models : {floor + slab, slab + floor}) {
    EXPECT_NEAR(speedingUpAt(models, 0, 0), 1, 1e-3);
    EXPECT_LT(speedingUpAt(models, -10, 0), allowed(0.05) / kReserve + 1e-3);
  }
}

TEST(Grip, IsThatOfASlabOnAPlane) {
  const std::string plane = fixed("plane", kPlane, 0.05);
  const std::string slab = fixed("slab", box("60 3 0.02"), 0.8, "0 0 0.01 0 0 0");
  for (const std::string& models : {plane + slab, slab + plane}) {
    EXPECT_NEAR(speedingUpAt(models, 0, 0), 1, 1e-3);
    EXPECT_NEAR(speedingUpAt(models, 0, 6), allowed(0.05), 1e-3);
  }
}

/// A strip of ice turned by 45°, through (0, 5) but not through (3, 5).
TEST(Grip, FollowsTheOutlineOfASurface) {
  const std::string floor = fixed("floor", box("100 100 0.1"), 0.8, "0 0 -0.05 0 0 0");
  const std::string strip = fixed("strip", box("40 1 0.1"), 0.05, "0 5 -0.05 0 0 0.785398");
  EXPECT_LT(speedingUpAt(floor + strip, 0, 5), 0.5);
  GripHall beside(floor + strip);
  beside.spawn("kiva", "kiva1", 5, 5);
  beside.rot(1, kLeft);  // in the strip's bounding box
  EXPECT_NEAR(beside.runUntilIdle(1), 0.626, 0.005);
}

/// A mesh about as high as the floor, such as a desk's plate on the ground.
TEST(Grip, OfAMeshIsItsOwn) {
  const std::string floor = fixed("floor", box("100 100 0.1"), 0.8, "0 0 -0.05 0 0 0");
  const std::string mesh = "<mesh><uri>file://" TESTS_DIR
                           "/worlds/meshes/hall_floor.obj</uri>"
                           "<scale>0.1 0.1 0.1</scale></mesh>";
  const std::string models = floor + fixed("desk", mesh, 0.05, "-30 -30 0 0 0 0");
  EXPECT_NEAR(speedingUpAt(models, 0, 0), 1, 1e-3);
}

TEST(Grip, OfSurfacesThatHoldEveryWheelChangesNothing) {
  const std::string floor = fixed("floor", box("100 100 0.1"), 1, "0 0 -0.05 0 0 0");
  const std::string slab = fixed("slab", box("1 1 0.1"), 100, "2 0 -0.05 0 0 0");
  std::uint64_t hashes[2];
  for (const bool has_slab : {false, true}) {
    GripHall hall(has_slab ? floor + slab
                           : floor + fixed("slab", box("1 1 0.1"), 1, "2 0 -0.05 0 0 0"));
    hall.spawn("kiva", "kiva1", 0, 0);
    hall.movx(1, 4);
    hall.runUntilIdle(1);
    hashes[has_slab] = static_cast<std::uint64_t>(hall.world.steps());
    hall.expectAt(1, 4, 0);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Grip, OutlivesACheckpoint) {
  const std::string floor = fixed("floor", box("100 100 0.1"), 0.8, "0 0 -0.05 0 0 0");
  GripHall hall(floor + fixed("slab", box("30 1 0.1"), 0.05, "0 0 -0.05 0 0 0"));
  hall.spawn("kiva", "kiva1", 0, 0);
  hall.movx(1, 5);
  hall.run(1);
  const std::string saved = hall.world.checkpoint();
  hall.run(2);
  const double x = hall.x(1);
  hall.world.restore(saved);
  hall.run(2);
  EXPECT_EQ(hall.x(1), x);
}

// --- the step

/// Returns the durations of a turn, a drive of 2 m and a lift at that step size, in arrays, in
/// Bullet or with wheel joints.
std::array<double, 3> durations(const char* drive, bool in_bullet, double step) {
  Floorplan plan;
  plan.step = step;
  plan.options.always_in_bullet = in_bullet;
  Warehouse w(plan);
  w.spawnText(kivaText({{"drive", drive}}), "kiva1", 0, 0);
  w.spawn("storage_unit", "storage_unit1", 2, 0);
  std::array<double, 3> taken{};
  w.movx(1, 2);
  taken[0] = w.runUntilIdle(1);
  w.rot(1, kLeft);
  taken[1] = w.runUntilIdle(1);
  w.carry(1, 1);
  taken[2] = w.runUntilIdle(1);
  return taken;
}

/// A command begins at a step and ends at one, and so do the parts of a motion.
TEST(StepSize, ChangesDurationsByTwoStepsAtMost) {
  for (const char* drive : {"traction", "jointed"}) {
    for (const bool in_bullet : {false, true}) {
      const auto exact = durations(drive, in_bullet, 0.001);
      for (const double step : {0.002, 0.005, 0.01}) {
        const auto taken = durations(drive, in_bullet, step);
        for (int motion = 0; motion < 3; ++motion) {
          EXPECT_NEAR(taken[motion], exact[motion], 2 * step)
              << drive << (in_bullet ? " in Bullet" : "") << " at " << step << ", motion "
              << motion;
        }
      }
    }
  }
}

}  // namespace
}  // namespace kiva::test
