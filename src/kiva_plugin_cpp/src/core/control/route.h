// SPDX-License-Identifier: Apache-2.0
//
// The way that one command takes over the grid.
#pragma once

#include <cstdio>
#include <deque>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/control/grid.h"

namespace kiva {

/// Why a command is refused, for a person.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// It is off the grid and finds no way back.
struct Wedged : Refusal {
  Wedged() : Refusal("it is off the grid and no free grid point is near that it gets to") {}
};

/// How near is there, for numbers that clients computed [m].
constexpr double kGoalTolerance = 0.001;

template <typename... Args>
std::string format(const char* pattern, Args... args) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, args...);
  return text;
}

/// These throw Refusal: the grid's coordinate, where `axis` is x or y [m]; that a goal is on the
/// floor; that the robot can drive.
double checkedGoal(const Settings& settings, double coordinate, char axis);
void checkGoal(const Scene& world, const Point& goal);
void checkMotion(const FleetState& fleet, int robot);

/// Plans the way of one robot, segment by segment; knows where each segment will leave it.
class Route {
 public:
  /// From where the robot stands; from off the grid it first returns to it: to `back`, if that is a
  /// free grid point near it, else to the nearest one. Throws Refusal if there is no way back.
  Route(const Scene& world, int robot, const Point* back = nullptr);

  Point at() const { return at_; }
  void rotate(int direction);
  /// Drives along one axis to that coordinate, facing it.
  void driveTo(int axis, double coordinate);
  void lift(MotionSegment::Kind kind, int unit);
  std::deque<MotionSegment> takeSegments() { return std::move(segments_); }

 private:
  void turnTo(double heading);
  MotionSegment makeDrive(State state) const;
  void recover(const Point* back);
  void driveOff(const Point& from, const Point& to);

  const Scene& world_;
  int robot_;
  PlanarPose here_;  ///< Where the robot believes to be.
  Point at_;
  double yaw_;
  std::deque<MotionSegment> segments_;
};

}  // namespace kiva
