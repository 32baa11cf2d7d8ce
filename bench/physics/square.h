// SPDX-License-Identifier: Apache-2.0
//
// The workload of the fleet: N robots on a 3 m lattice inside walls, each driving a square of 1 m,
// one second a side at 1 m/s, one second a quarter turn; a laser of 20 rays over 180°, 5 m, 10 Hz;
// 1 ms steps. The robot is worlds/models/kiva, as far as the engines beside ours need it.
#pragma once

#include <cmath>

namespace bench {

constexpr double kLattice = 3.0;  // [m]
constexpr double kStep = 0.001;   // [s]

constexpr int kRays = 20;
constexpr double kRange = 5.0;      // [m]
constexpr int kStepsPerScan = 100;  // 10 Hz
constexpr double kLaserAhead =
    0.4;  // distance ahead of the robot's centre, just beyond its body [m]
constexpr double kLaserHeight = 0.2;

constexpr double kLength = 0.76, kWidth = 0.64, kHeight = 0.33;          // size of the body [m]
constexpr double kBodyHeight = 0.195;                                    // height of its centre [m]
constexpr double kWheelRadius = 0.1, kWheelWidth = 0.05, kTrack = 0.52;  // [m]

/// Where robot `i` of `robots` starts, and the floor it drives on.
struct Lattice {
  explicit Lattice(int robots) : columns(static_cast<int>(std::ceil(std::sqrt(robots)))) {}
  double x(int i) const { return corner() + i % columns * kLattice; }
  double y(int i) const { return corner() + i / columns * kLattice; }
  double corner() const { return std::round(-columns * kLattice / 2); }
  double size() const { return columns * kLattice + 6; }  ///< Between the walls [m].

  int columns;
};

struct PlanarTwist {
  double speed = 0;     ///< [m/s]
  double yaw_rate = 0;  ///< [rad/s]
};

/// Returns the command of a robot at a step. Robots take turns, so that all chunks cost the same.
inline PlanarTwist command(int robot, long step) {
  constexpr long kSide = 1000, kStagger = 137;  // steps
  const bool straight = (step + robot * kStagger) / kSide % 2 == 0;
  return straight ? PlanarTwist{1, 0} : PlanarTwist{0, M_PI / 2};
}

inline bool scanDue(int robot, long step) { return (step + robot) % kStepsPerScan == 0; }

/// Returns the angle of ray k to the robot's heading [rad].
inline double rayAngle(int k) { return -M_PI / 2 + M_PI * k / (kRays - 1); }

}  // namespace bench
