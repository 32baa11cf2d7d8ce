// SPDX-License-Identifier: Apache-2.0
#include "core/state/progress/path_progress.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/angle.h"
#include "core/state/places/footprints.h"

namespace kiva {
namespace {

constexpr double kCentred = 0.001;  // [m] from a point within which the robot has reached it
constexpr double kFacing =
    0.002;  // [rad] of heading error with which it can drive, even if it was pushed while it stood
constexpr double kNearlyFacing = 0.02;  // [rad] likewise, for a robot with an estimated pose
constexpr double kCellRounding = 1e-9;  // [m]

/// A position relative to the origin of a run [m].
struct OnRun {
  double along, beside;
};

/// The frame of the present run, which is along an axis: cosine and sine of its heading are
/// integers, and known without computing them, at every point that is counted.
class RunFrame {
 public:
  explicit RunFrame(const Task& task) : path_(task.path), segment_(task.segments.front()) {
    constexpr double kCosine[] = {1, 0, -1, 0};
    const int quarters =
        static_cast<int>(segment_.yaw / kHalfPi + std::copysign(0.5, segment_.yaw));
    cosine_ = kCosine[quarters & 3];
    sine_ = kCosine[(quarters + 3) & 3];
  }

  OnRun operator()(std::uint32_t point) const {
    const double dx = path_[point].x - segment_.x, dy = path_[point].y - segment_.y;
    return {cosine_ * dx + sine_ * dy, cosine_ * dy - sine_ * dx};
  }

 private:
  const ReleasedPath& path_;
  const MotionSegment& segment_;
  double cosine_, sine_;
};

/// Returns the distance from a cell's centre, ahead and aside, at which the robot is out of the
/// cell [m].
OnRun outOfCell(const Scene& world, int robot) {
  const Robot& r = world.fleet.robots[robot];
  const double half = world.settings.grid_spacing / 2 - kCellRounding;
  return {half + halfLength(r), half + halfWidth(r)};
}

double headingOf(const PathPoint& from, const PathPoint& to) {
  return std::atan2(to.y - from.y, to.x - from.x);
}

MotionSegment turnTo(double heading) {
  MotionSegment turn;
  turn.yaw = heading;
  return turn;
}

/// Returns the run from its origin along a heading.
MotionSegment driveAlong(const WorldSettings& settings, const ReleasedPath& path, double heading) {
  const PathPoint &from = path[path.origin], &to = path[path.end];
  MotionSegment run;
  run.kind = MotionSegment::Kind::kDrive;
  run.x = from.x;
  run.y = from.y;
  run.yaw = heading;
  run.length = std::abs(to.x - from.x) + std::abs(to.y - from.y);
  run.state =
      std::abs(to.x - from.x) > settings.grid_spacing / 2 ? State::kMovingX : State::kMovingY;
  return run;
}

}  // namespace

MotionSegment nextSegment(const Scene& world, int robot) {
  const Task& task = world.fleet.tasks[robot];
  const ReleasedPath& path = task.path;
  const double yaw = world.fleet.believed(robot).yaw;
  const double square = squareTo(yaw);
  const double ahead = headingOf(path[path.origin], path[path.origin + 1]);
  const double heading = headingNear(square, ahead);
  const bool faces_it = std::abs(heading - yaw) < (world.fleet.localises ? kNearlyFacing : kFacing);
  return faces_it ? driveAlong(world.settings, path, heading) : turnTo(heading);
}

double alongSegment(const FleetState& f, int i) {
  const MotionSegment& segment = f.tasks[i].segments.front();
  const PlanarPose at = f.believed(i);
  return std::cos(segment.yaw) * (at.x - segment.x) + std::sin(segment.yaw) * (at.y - segment.y);
}

double alongRun(const Task& task, std::uint32_t point) { return RunFrame(task)(point).along; }

void countPoints(RobotView& world, int robot, double along) {
  FleetState& f = world.fleet;
  const Task& task = f.tasks[robot];
  if (!task.isOnRun()) return;
  std::uint32_t& reached = f.reached[robot];
  std::uint32_t& left = f.left[robot];
  const RunFrame run(task);
  while (reached <= task.path.end && along >= run(reached).along - kCentred) ++reached;
  const OnRun out = outOfCell(world, robot);
  const auto isLeft = [&](std::uint32_t point) {
    const OnRun at = run(point);
    return along - at.along >= out.along || std::abs(at.beside) >= out.beside;
  };
  while (left < reached && isLeft(left)) ++left;
}

double nextCount(const Scene& world, int robot) {
  const FleetState& f = world.fleet;
  const Task& task = f.tasks[robot];
  double next = std::numeric_limits<double>::infinity();
  if (!task.isOnRun()) return next;
  const std::uint32_t reached = f.reached[robot], left = f.left[robot];
  const RunFrame run(task);
  if (reached <= task.path.end) next = run(reached).along - kCentred;
  if (left < reached) next = std::min(next, run(left).along + outOfCell(world, robot).along);
  return next;
}

std::vector<PathPoint> pointsAhead(const FleetState& fleet, int robot) {
  const ReleasedPath& path = fleet.tasks[robot].path;
  std::vector<PathPoint> points;
  for (std::uint32_t k = fleet.reached[robot]; k < path.size(); ++k) {
    const bool ends = k + 1 == path.size() || k + 1 == path.released;
    if (ends || !path.isStraight(k - 1, k, k + 1)) points.push_back(path[k]);
  }
  return points;
}

}  // namespace kiva
