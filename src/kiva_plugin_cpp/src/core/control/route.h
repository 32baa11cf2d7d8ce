// SPDX-License-Identifier: Apache-2.0
//
// Plans the way of one robot for one command, along the grid.
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

/// A refusal because the robot is off the grid, without a way back.
struct Wedged : Refusal {
  Wedged() : Refusal("it is off the grid, and it reaches no free grid point nearby") {}
};

/// A refusal because a client drives the robot by velocities.
struct Steered : Refusal {
  explicit Steered(const std::string& name)
      : Refusal("it is driven by /" + name +
                "/cmd_vel: give it back to the grid first, by /warehouse/set_cmd_vel") {}
};

/// Tolerance of goals that clients computed [m].
constexpr double kGoalTolerance = 0.001;

template <typename... Args>
std::string format(const char* pattern, Args... args) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, args...);
  return text;
}

/// Returns the coordinate of the grid point at `coordinate` along `axis` (x or y) [m]. Throws
/// Refusal if there is none within kGoalTolerance.
double checkedGoal(const WorldSettings& settings, double coordinate, char axis);
/// Throws Refusal if the goal is off the floor.
void checkGoal(const Scene& world, const Point& goal);
/// Throws Refusal if the robot can't drive.
void checkMotion(const FleetState& fleet, int robot);

/// The way of one robot, built segment by segment. The route keeps the pose after each.
class Route {
 public:
  /// Starts at the robot's pose. A robot off the grid first returns to it: to the grid point `back`
  /// if that is near and free, otherwise to the nearest free one. Throws Refusal if no point is
  /// free.
  Route(const Scene& world, int robot, const Point* back = nullptr);

  Point at() const { return at_; }
  void rotate(int direction);
  /// Turns towards a coordinate along one axis and drives there.
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
  PlanarPose here_;  ///< The pose that the robot believes to have.
  Point at_;
  double yaw_;
  std::deque<MotionSegment> segments_;
};

}  // namespace kiva
