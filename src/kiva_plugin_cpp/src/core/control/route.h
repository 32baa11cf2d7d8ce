// SPDX-License-Identifier: Apache-2.0
//
// Plans the way of one command over the grid.
#pragma once

#include <cstdio>
#include <deque>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/control/grid.h"

namespace kiva {

/// The reason why a command is refused, as a client reads it.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The refusal of a robot that is off the grid and finds no way back.
struct Wedged : Refusal {
  Wedged() : Refusal("it is off the grid and no free grid point is near that it gets to") {}
};

/// The tolerance for goals that clients computed [m].
constexpr double kGoalTolerance = 0.001;

template <typename... Args>
std::string format(const char* pattern, Args... args) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, args...);
  return text;
}

/// Returns the grid's coordinate along `axis`, x or y [m]. Throws Refusal off the grid.
double checkedGoal(const Settings& settings, double coordinate, char axis);
/// Throws Refusal if the goal is off the floor.
void checkGoal(const Scene& world, const Point& goal);
/// Throws Refusal if the robot can't drive.
void checkMotion(const FleetState& fleet, int robot);

/// Plans the way of one robot, segment by segment, and keeps track of the pose after each.
class Route {
 public:
  /// Starts from the robot's pose. A robot off the grid first returns to it: to `back`, if that is
  /// a free grid point near it, else to the nearest one. Throws Refusal if there is no way back.
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
