// SPDX-License-Identifier: Apache-2.0
//
// Odometry of robots and its stated uncertainty.
#include <array>
#include <memory>

#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr int kRobots = 50;

/// The normalised estimation error squared: errors in units of the covariance (Bar-Shalom
/// et al. 2001, 5.4.2).
template <std::size_t N>
double squared(const std::array<double, N>& error, std::array<double, N * N> covariance) {
  std::array<double, N> rest = error;
  double sum = 0;
  for (std::size_t i = 0; i < N; ++i) {  // Gauss: the covariance is positive definite
    sum += rest[i] * rest[i] / covariance[N * i + i];
    for (std::size_t j = i + 1; j < N; ++j) {
      const double share = covariance[N * j + i] / covariance[N * i + i];
      rest[j] -= share * rest[i];
      for (std::size_t k = i; k < N; ++k) covariance[N * j + k] -= share * covariance[N * i + k];
    }
  }
  return sum;
}

/// Means over the robots.
struct Nees {
  double pose = 0, twist = 0;
};

// Bounds of the means that 99.9 % of fleets of fifty stay within, by chi-square: three numbers of a
// pose, two of a twist.
constexpr double kLeastPose = 1.94, kMostPose = 4.28;
constexpr double kLeastTwist = 1.20, kMostTwist = 3.06;

class Odometries : public ::testing::Test {
 protected:
  void place(const LocalisationRealism& real) {
    Floorplan plan{200};
    plan.options.realism.emplace().localisation = real;
    w = std::make_unique<Warehouse>(plan);
    for (int id = 1; id <= kRobots; ++id) {
      w->spawn("kiva", "kiva" + std::to_string(id), 0, 3 * id - 75);
    }
  }

  Nees nees() const {
    Nees sum;
    const Fleet& f = w->world.fleet();
    for (int i = 0; i < kRobots; ++i) {
      const Odometry o = w->world.odometry(i);
      const std::array<double, 3> pose{o.pose.X() - f.x[i], o.pose.Y() - f.y[i],
                                       std::remainder(o.pose.Z() - f.yaw[i], 2 * M_PI)};
      sum.pose += squared<3>(pose, o.pose_covariance) / kRobots;
      if (o.speed == 0 && o.turn_rate == 0) continue;  // wheels that stand say so exactly
      const double speed = std::cos(f.yaw[i]) * f.vx[i] + std::sin(f.yaw[i]) * f.vy[i];
      const std::array<double, 2> twist{o.speed - speed, o.turn_rate - f.yaw_rate[i]};
      sum.twist += squared<2>(twist, o.twist_covariance) / kRobots;
    }
    return sum;
  }

  void expectConsistentPoses(const std::string& when) const {
    const double pose = nees().pose;
    EXPECT_GT(pose, kLeastPose) << when;
    EXPECT_LT(pose, kMostPose) << when;
  }
  /// Runs, and looks every half a second.
  void drive(double seconds) {
    for (double time = 0.5; time < seconds; time += 0.5) {
      w->run(0.5);
      expectConsistentPoses("after " + number(time) + " s");
      const double twist = nees().twist;
      EXPECT_GT(twist, kLeastTwist) << "after " << time << " s";
      EXPECT_LT(twist, kMostTwist) << "after " << time << " s";
    }
  }
  template <typename Command>
  void command(Command give) {
    for (int id = 1; id <= kRobots; ++id) give(id);
  }
  void finish(const std::string& what) {
    command([&](int id) {
      if (w->status(id) != Status::kIdle) w->runUntilIdle(id);
    });
    expectConsistentPoses(what);
  }

  void tryAll(const LocalisationRealism& real) {
    place(real);
    expectConsistentPoses("placed");
    command([&](int id) { w->movx(id, 8); });
    drive(6);
    finish("driven");
    command([&](int id) { w->rot(id, kLeft); });
    w->run(0.3);
    // Less is well: a robot that turns in place stays there, though its wheels could slip.
    EXPECT_LT(nees().twist, kMostTwist);
    finish("turned");
    command([&](int id) { w->movy(id, 2); });
    drive(2);
    finish("driven on");
  }

  std::unique_ptr<Warehouse> w;
};

TEST_F(Odometries, AreAsUncertainAsTheySay) {
  LocalisationRealism typical;
  typical.enabled = true;
  tryAll(typical);
}

TEST_F(Odometries, AreAsUncertainAsTheySayOnABadDay) {
  LocalisationRealism bad;
  bad.enabled = true;
  bad.wheel_radius_error = 0.0015;
  bad.wheel_separation_error = 0.003;
  bad.slip = 0.0004;
  bad.code_position_noise = 0.001;
  bad.code_angle_noise = 0.0015;
  bad.missed_codes = 0.01;
  tryAll(bad);
}

TEST_F(Odometries, AreExactWhereLocalisationIsIdeal) {
  place({});
  w->movx(1, 4);
  w->run(2);
  const Odometry o = w->world.odometry(w->index(1));
  EXPECT_EQ(o.pose.X(), w->x(1));
  EXPECT_EQ(o.speed, w->speed(1));
  for (const double variance : o.pose_covariance) EXPECT_EQ(variance, 0);
  for (const double variance : o.twist_covariance) EXPECT_EQ(variance, 0);
}

/// UMBmark (Borenstein and Feng 1996): a square of 4 m and back, by dead reckoning.
class Umbmark : public ::testing::Test {
 protected:
  static constexpr double kSide = 4;  // [m]

  Umbmark() : w(plan()) { w.spawn("kiva", "kiva1", 0, 0); }
  static Floorplan plan() {
    Floorplan plan{100};
    LocalisationRealism& real = plan.options.realism.emplace().localisation;
    real = {true, 0.003, 0.005, 0, 0, 0, 1, 1000};  // wheels off, no slip, no codes
    return plan;
  }
  const DriveSizes& believed() { return insideOf(w.world).fleet.localisation[0].believed; }

  /// Returns the pose after wheels of the true sizes are turned as the believed sizes demand.
  Pose expected(int direction) {
    const DriveParameters& drive = w.robot(1).drive;
    Pose at;
    const auto go = [&](double way, double turn) {
      double rolled[2];
      for (int wheel = 0; wheel < 2; ++wheel) {
        const double side = wheel == 0 ? -1 : 1;
        rolled[wheel] = (way + side * turn * believed().separation / 2) * drive.wheel_radius /
                        believed().radius[wheel];
      }
      const double gone = way == 0 ? 0 : (rolled[0] + rolled[1]) / 2;
      const double turned = (rolled[1] - rolled[0]) / drive.wheel_separation;
      const double chord = turned == 0 ? gone : 2 * gone / turned * std::sin(turned / 2);
      at = at * Pose(0, 0, 0, 0, 0, turned / 2) * Pose(chord, 0, 0, 0, 0, turned / 2);
    };
    for (int leg = 0; leg < 4; ++leg) {
      go(kSide, 0);
      if (leg < 3) go(0, direction * kQuarter);
    }
    return at;
  }
  void driveSquare(int direction) {
    w.mov(1, kSide, 0);
    w.runUntilIdle(1);
    w.mov(1, kSide, direction * kSide);
    w.runUntilIdle(1);
    w.mov(1, 0, direction * kSide);
    w.runUntilIdle(1);
    w.mov(1, 0, 0);
    w.runUntilIdle(1);
  }

  Warehouse w;
};

TEST_F(Umbmark, ASquareEndsWhereWheelsOfOtherSizesTakeIt) {
  for (const int direction : {kLeft, kRight}) {
    w.world.setState("kiva1", {Pose::Zero, {}});
    const Pose there = expected(direction);
    EXPECT_GT(there.Pos().Length(), 0.01);
    driveSquare(direction);
    EXPECT_NEAR(w.x(1), there.X(), 0.002) << direction;
    EXPECT_NEAR(w.y(1), there.Y(), 0.002) << direction;
    EXPECT_NEAR(std::remainder(w.yaw(1) - there.Rot().Yaw(), 2 * M_PI), 0, 0.001) << direction;
  }
}

}  // namespace
}  // namespace kiva::test
