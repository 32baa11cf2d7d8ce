// SPDX-License-Identifier: Apache-2.0
#include "core/control/recovery.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/angle.h"
#include "core/sensing/room.h"

namespace kiva {
namespace {

constexpr int kCells = 2;  // range around a robot in which it may return to the grid [cells]
constexpr double kRoomStep = 0.1;     // [m] between places that are searched for room to turn
constexpr double kRoomReach = 1.5;    // [m]
constexpr double kShift = 0.025;      // [m] that a wedged robot drives before it searches again
constexpr double kSamePlace = 0.001;  // [m]

// Clearance at the sides of a robot [m]; a wedged robot may push a leg aside a little.
constexpr double kSideClearance = 0.002, kScrape = -0.01;

double distance(const Point& a, const Point& b) { return std::hypot(b.x - a.x, b.y - a.y); }

std::vector<Point> gridAround(const WorldSettings& settings, const Point& here) {
  std::vector<Point> points;
  for (int i = -kCells; i <= kCells; ++i) {
    for (int j = -kCells; j <= kCells; ++j) {
      points.push_back({nearestGrid(settings, here.x) + i * settings.grid_spacing,
                        nearestGrid(settings, here.y) + j * settings.grid_spacing});
    }
  }
  std::stable_sort(points.begin(), points.end(), [&](const Point& a, const Point& b) {
    return distance(here, a) < distance(here, b);
  });
  return points;
}

/// Returns the grid points around a point that lie on the floor, the nearest first.
std::vector<Point> goalsAround(const Scene& world, const Point& here) {
  std::vector<Point> points = gridAround(world.settings, here);
  const auto is_outside = [&](const Point& p) { return !isOnFloor(world, p); };
  points.erase(std::remove_if(points.begin(), points.end(), is_outside), points.end());
  return points;
}

/// Returns that goal alone if it is among the goals.
std::vector<Point> only(const Point& goal, const std::vector<Point>& goals) {
  for (const Point& known : goals) {
    if (distance(known, goal) < kSamePlace) return {known};
  }
  return {};
}

/// Returns the pose `way` ahead along the heading [m].
PlanarPose shifted(const PlanarPose& from, double way) {
  return {from.x + std::cos(from.yaw) * way, from.y + std::sin(from.yaw) * way, from.yaw};
}

/// Returns the distances straight ahead at which to search for room to turn [m]: in steps, and
/// beside grid points.
std::vector<double> waysToRoom(const WorldSettings& settings, const PlanarPose& at) {
  std::vector<double> ways;
  for (int step = 1; step * kRoomStep <= kRoomReach; ++step) {
    for (double way : {step * kRoomStep, -step * kRoomStep}) ways.push_back(way);
  }
  for (const Point& p : gridAround(settings, {at.x, at.y})) {
    ways.push_back(std::cos(at.yaw) * (p.x - at.x) + std::sin(at.yaw) * (p.y - at.y));
  }
  std::stable_sort(ways.begin(), ways.end(),
                   [](double a, double b) { return std::abs(a) < std::abs(b); });
  return ways;
}

/// Searches a way for one robot: the points to which it drives straight; empty if no way exists.
class ReturnSearch {
 public:
  ReturnSearch(const Scene& world, int robot, std::vector<Point> goals, double margin)
      : world_(world), robot_(robot), goals_(std::move(goals)), margin_(margin) {}

  /// Searches a way from that pose, or from a pose a little ahead or behind.
  std::vector<Point> wayFromNear(const PlanarPose& at) const {
    std::vector<Point> way = wayFrom(at);
    if (!way.empty()) return way;
    visitStraight(at, {kShift, -kShift, 2 * kShift, -2 * kShift, 3 * kShift, -3 * kShift},
                  [&](const PlanarPose& there) {
                    way = wayFrom(there);
                    if (!way.empty()) way.insert(way.begin(), {there.x, there.y});
                    return !way.empty();
                  });
    return way;
  }

 private:
  /// Searches a way to a goal: by turning as far as the robot can here, or straight on or square to
  /// a place with room. A robot that was hit while it turned stands askew.
  std::vector<Point> wayFrom(const PlanarPose& at) const {
    const TurnRoom room = roomToTurn(world_, robot_, at, Among::kAll);
    if (const Point* goal = findGoal(at, room)) return {*goal};
    const double square = squareTo(at.yaw);
    for (double heading : {at.yaw, square, square + std::copysign(kHalfPi, at.yaw - square)}) {
      if (!room.holds(heading)) continue;
      const std::vector<Point> way = wayByRoom({at.x, at.y, heading});
      if (!way.empty()) return way;
    }
    return {};
  }

  /// Searches a way straight on to a place with room to turn around, then to a goal.
  std::vector<Point> wayByRoom(const PlanarPose& at) const {
    std::vector<Point> way;
    visitStraight(at, waysToRoom(world_.settings, at), [&](const PlanarPose& there) {
      const bool has_room = hasRoomToTurn(world_, robot_, there.x, there.y);
      const Point* goal = has_room ? findGoal(there, TurnRoom()) : nullptr;
      if (goal) way = {{there.x, there.y}, *goal};
      return goal != nullptr;
    });
    return way;
  }

  /// Returns the first goal to which the robot can drive from there and turn square; null if it can
  /// reach no goal.
  const Point* findGoal(const PlanarPose& from, const TurnRoom& room) const {
    for (const Point& goal : goals_) {
      const StraightWay way = straightWay(from, goal);
      const PlanarPose begin{from.x, from.y, way.heading}, end{goal.x, goal.y, way.heading};
      if (room.holds(way.heading) && isWayFree(world_, robot_, begin, way.length, margin_) &&
          isFree(world_, robot_, goal.x, goal.y) &&
          roomToTurn(world_, robot_, end, Among::kAll).holds(squareTo(way.heading))) {
        return &goal;
      }
    }
    return nullptr;
  }

  /// Calls visit(pose) for the places straight ahead and behind to which the robot can drive, at
  /// those distances, until a call returns true.
  template <typename Visit>
  void visitStraight(const PlanarPose& at, const std::vector<double>& ways, Visit visit) const {
    bool is_open[] = {true, true};  // behind, ahead
    for (double way : ways) {
      bool& open = is_open[way > 0];
      open = open && isWayFree(world_, robot_, at, way, margin_);
      if (open && visit(shifted(at, way))) return;
    }
  }

  const Scene& world_;
  const int robot_;
  const std::vector<Point> goals_;
  const double margin_;
};

}  // namespace

StraightWay straightWay(const PlanarPose& from, const Point& to) {
  const double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
  if (length < kSamePlace) return {from.yaw, 0};
  const double ahead = headingNear(from.yaw, std::atan2(dy, dx));
  const double back = headingNear(from.yaw, std::atan2(-dy, -dx));
  const bool reverse = std::abs(back - from.yaw) < std::abs(ahead - from.yaw);
  return {reverse ? back : ahead, reverse ? -length : length};
}

std::vector<Point> findWayBack(const Scene& world, int robot, const Point* back) {
  const PlanarPose at = world.fleet.believed(robot);
  const std::vector<Point> goals = goalsAround(world, {at.x, at.y});
  const std::vector<Point> preferred = back ? only(*back, goals) : std::vector<Point>();
  for (const std::vector<Point>& to : {preferred, goals}) {
    for (double margin : {kSideClearance, kScrape}) {
      if (to.empty()) continue;
      std::vector<Point> way = ReturnSearch(world, robot, to, margin).wayFromNear(at);
      if (!way.empty()) return way;
    }
  }
  return {};
}

}  // namespace kiva
