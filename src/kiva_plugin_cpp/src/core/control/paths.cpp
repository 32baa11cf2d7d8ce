// SPDX-License-Identifier: Apache-2.0
#include "core/control/paths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/control/route.h"
#include "core/geometry/solid.h"
#include "core/motion/driving/cruise.h"
#include "core/sensing/look_ahead.h"
#include "core/state/places/footprints.h"
#include "core/state/progress/path_progress.h"
#include "core/state/progress/tasks.h"

namespace kiva {
namespace {

constexpr double kKeepOff = 0.001;  // [m] of a robot's sides that may touch an obstacle
constexpr double kCentred = 0.001;  // [m] within which a robot is on its point
constexpr std::uint64_t kMostPoints = 100000;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();  // [m/s]

/// Checks a message's numbers. `known`: count of the path's points so far, of which the first
/// `forgotten` were left. Throws Refusal.
void checkNumbers(const FollowPath& m, std::uint64_t known, std::uint64_t forgotten) {
  if (!m.fault.empty()) throw Refusal(m.fault);
  if (m.path_id == 0) throw Refusal("path_id 0: another number was expected");
  if (m.x.size() != m.y.size()) {
    throw Refusal(format("%zu x and %zu y: as many of both were expected", m.x.size(), m.y.size()));
  }
  if (!m.max_speed.empty() && m.max_speed.size() != m.x.size()) {
    throw Refusal(format("%zu x and %zu max_speed: as many of both, or no max_speed, were expected",
                         m.x.size(), m.max_speed.size()));
  }
  if (m.first > known) {
    throw Refusal(format("first %u: the path has %u points so far, so that some are missing",
                         m.first, static_cast<unsigned>(known)));
  }
  if (m.first + m.x.size() > forgotten + kMostPoints) {
    throw Refusal(format("%zu points ahead: at most %u were expected",
                         m.first + m.x.size() - forgotten, static_cast<unsigned>(kMostPoints)));
  }
  if (m.released == 0) throw Refusal("released 0: it stands on point 0, so at least 1 is");
}

PathPoint checkedPoint(const Scene& world, const FollowPath& m, std::size_t k) {
  const Point p{checkedGoal(world.settings, m.x[k], 'x'), checkedGoal(world.settings, m.y[k], 'y')};
  checkGoal(world, p);
  return {p.x, p.y};
}

bool isSame(const PathPoint& a, const PathPoint& b) {
  return std::abs(a.x - b.x) < kGoalTolerance && std::abs(a.y - b.y) < kGoalTolerance;
}

/// Returns whether a model is a part of the building, or a belt, and so will not move. A model
/// shorter than a cell that stands alone may move: it may be a person.
bool isBuilding(const Scene& world, const Model& model) {
  const std::uint8_t as = model.owner->occupies(world, model);
  if (as == Occupancy::kBelt) return true;
  if (as != Occupancy::kTaken || !model.isStatic()) return false;
  const Vector3 size = bounds(*model.description).max - bounds(*model.description).min;
  return std::max(size.X(), size.Y()) > world.settings.grid_spacing - kGoalTolerance;
}

/// Throws Refusal if a robot would drive into the building between two neighbours.
void checkClear(const Scene& world, int robot, const PathPoint& from, const PathPoint& to) {
  const Robot& r = world.fleet.robots[robot];
  Footprint swept;
  swept.x = (from.x + to.x) / 2;
  swept.y = (from.y + to.y) / 2;
  const bool along_x = std::abs(to.x - from.x) > std::abs(to.y - from.y);
  const double way = std::abs(to.x - from.x) + std::abs(to.y - from.y);
  swept.hx = along_x ? way / 2 + halfLength(r) : halfWidth(r);
  swept.hy = along_x ? halfWidth(r) : way / 2 + halfLength(r);
  swept.hx -= kKeepOff;
  swept.hy -= kKeepOff;
  swept.z_min = world.floor.extent.z;
  swept.z_max = world.floor.extent.z + (world.fleet.unit[robot] < 0 ? r.height : 1e9);
  const Model* hit = nullptr;
  world.obstacles.near(swept.x, swept.y, std::max(swept.hx, swept.hy), [&](const Footprint& other) {
    if (hit || !shareHeight(other, swept) || gap(swept, other) >= 0) return;
    const Model& model = *world.models[other.model];
    if (isBuilding(world, model)) hit = &model;
  });
  if (!hit) return;
  throw Refusal(
      format("%s is between (%g, %g) and (%g, %g)", hit->name.c_str(), from.x, from.y, to.x, to.y));
}

/// Throws Refusal if a robot can't drive straight from one point to the other.
void checkLink(const Scene& world, int robot, const PathPoint& from, const PathPoint& to,
               std::uint64_t number) {
  const bool moves_x = std::abs(to.x - from.x) > kGoalTolerance;
  const bool moves_y = std::abs(to.y - from.y) > kGoalTolerance;
  if (moves_x == moves_y) {
    throw Refusal(
        format("point %u at (%g, %g) does not differ from (%g, %g), the one before, "
               "along one axis",
               static_cast<unsigned>(number), to.x, to.y, from.x, from.y));
  }
  checkClear(world, robot, from, to);
}

void checkReleased(const FollowPath& m, std::uint64_t size) {
  if (m.released <= size) return;
  throw Refusal(
      format("released %u: the path has %u points", m.released, static_cast<unsigned>(size)));
}

bool hasTurns(const FleetState& fleet, int robot, const std::vector<PathPoint>& points) {
  double angle = fleet.yaw[robot];
  for (std::size_t k = 1; k < points.size(); ++k) {
    const double next = std::atan2(points[k].y - points[k - 1].y, points[k].x - points[k - 1].x);
    if (std::abs(std::remainder(next - angle, 2 * M_PI)) > M_PI / 4) return true;
    angle = next;
  }
  return false;
}

void checkTurns(const FleetState& fleet, int robot, const std::vector<PathPoint>& points) {
  if (fleet.robots[robot].has_rotation || !hasTurns(fleet, robot, points)) return;
  throw Refusal("it has no rotation plugin");
}

// --- a change of the path under way

/// Returns the new points of a message. Throws Refusal if the message changes a released point, or
/// the robot can't drive to a new one.
std::vector<PathPoint> checkedChange(const Scene& world, int robot, const FollowPath& m) {
  const ReleasedPath& path = world.fleet.tasks[robot].path;
  const std::uint32_t committed = std::min(path.released, m.released);
  std::vector<PathPoint> points(m.x.size());
  bool is_new = false;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto number = static_cast<std::uint32_t>(m.first + k);
    points[k] = {m.x[k], m.y[k]};
    if (number < path.first) continue;  // left, and no longer stored
    const bool was_new = is_new;
    is_new = number >= path.size() || !isSame(points[k], path[number]);
    if (is_new && number < committed) {
      throw Refusal(
          format("point %u is released and can't become (%g, %g)", number, m.x[k], m.y[k]));
    }
    points[k] = is_new ? checkedPoint(world, m, k) : path[number];
    if (!is_new && !was_new) continue;
    checkLink(world, robot, k > 0 ? points[k - 1] : path[number - 1], points[k], number);
  }
  return points;
}

bool isLimit(double speed) { return std::isfinite(speed); }

/// Returns the speed limits of a path after a message with these points; empty if none is finite.
std::vector<double> limitsAfter(const ReleasedPath& path, const FollowPath& m,
                                const std::vector<PathPoint>& points) {
  std::vector<double> limits = path.limits;
  if (points.empty() || (limits.empty() && m.max_speed.empty())) return limits;
  const auto old = [&](std::uint32_t number) {
    return path.isLimited() ? path.limitTo(number) : kNoLimit;
  };
  limits.resize(std::max(path.first, m.first) - path.first, kNoLimit);
  for (auto number = path.first + static_cast<std::uint32_t>(limits.size());
       number < m.first + points.size(); ++number) {
    const std::size_t k = number - m.first;
    const bool is_known = number < path.size() && isSame(points[k], path[number]);
    limits.push_back(!m.max_speed.empty() ? m.max_speed[k] : is_known ? old(number) : kNoLimit);
  }
  if (std::none_of(limits.begin(), limits.end(), isLimit)) limits.clear();
  return limits;
}

/// The end of the present run, and the distance to it along the run.
struct RunEnd {
  std::uint32_t point;
  double along;
};

/// Returns the end of the run if `released` points are released. Throws Refusal if the robot can't
/// stop there.
RunEnd checkedRunEnd(const Scene& world, int robot, std::uint32_t released) {
  const FleetState& f = world.fleet;
  const Task& task = f.tasks[robot];
  const auto tooLate = [&] {
    return Refusal(format("released %u: it can no longer stop there; it has come to %u points",
                          released, f.reached[robot]));
  };
  if (released <= task.path.origin) throw tooLate();
  const std::uint32_t end = std::min(task.path.end, released - 1);
  if (!task.isOnRun()) return {end, 0};  // the robot stands, turns, or drives to the path
  const double along = alongRun(task, end);
  if (end == task.path.end) return {end, along};
  if (task.drives()) {
    if (!f.command(robot).canStopAt(along, f.deceleration[robot], world.clock.dt)) throw tooLate();
  } else if (alongSegment(f, robot) > along + kCentred) {
    throw tooLate();
  }
  return {end, along};
}

void setRunEnd(TaskView& world, Obstacles& obstacles, int robot, double goal) {
  FleetState& f = world.fleet;
  Task& task = f.tasks[robot];
  if (task.segments.front().length == goal) return;
  task.segments.front().length = goal;
  if (task.phase == Phase::kDriving) setReferenceEnd(world, obstacles, robot, goal);
  if (task.phase == Phase::kBraking)
    setReferenceEnd(world, obstacles, robot, std::min(f.reference_end[robot], goal));
}

}  // namespace

bool changesPath(const FleetState& fleet, int robot, const FollowPath& m) {
  return fleet.tasks[robot].follows() && fleet.path_id[robot] == m.path_id;
}

void startPath(TaskView& world, int robot, std::uint32_t number, const FollowPath& m) {
  const FleetState& f = world.fleet;
  checkMotion(world.fleet, robot);
  if (m.path_id != 0 && m.path_id == f.path_id[robot]) {
    throw Refusal(format("path %u is over", m.path_id));
  }
  checkNumbers(m, 0, 0);
  checkReleased(m, m.x.size());
  ReleasedPath path;
  for (std::size_t k = 0; k < m.x.size(); ++k) {
    path.points.push_back(checkedPoint(world, m, k));
    if (k > 0) checkLink(world, robot, path.points[k - 1], path.points[k], k);
  }
  path.released = m.released;
  path.limits = limitsAfter({}, m, path.points);
  checkTurns(world.fleet, robot, path.points);
  const Point begin{path.points[0].x, path.points[0].y};
  Route route(world, robot, &begin);
  const PathPoint here{route.at().x, route.at().y};
  if (!isSame(here, path.points[0])) {
    throw Refusal(
        format("point 0 is (%g, %g), and it stands on (%g, %g)", m.x[0], m.y[0], here.x, here.y));
  }
  Task& task = world.fleet.tasks[robot];
  task.command = number;
  task.request = format("follow path %u", m.path_id);
  reportCommand(world, world.log, Event::Kind::kAccepted, robot, "", task.request);
  beginPath(world, robot, m.path_id, std::move(path), route.takeSegments());
}

void changePath(TaskView& world, Obstacles& obstacles, int robot, const FollowPath& m) {
  Task& task = world.fleet.tasks[robot];
  if (task.cancelled) throw Refusal(format("path %u is being cancelled", m.path_id));
  if (task.phase == Phase::kHalting) throw Refusal(format("path %u ends here", m.path_id));
  ReleasedPath& path = task.path;
  checkNumbers(m, path.size(), path.first);
  const std::uint64_t size = m.x.empty() ? path.size() : m.first + m.x.size();
  checkReleased(m, size);
  const RunEnd end = checkedRunEnd(world, robot, m.released);
  const std::vector<PathPoint> points = checkedChange(world, robot, m);
  checkTurns(world.fleet, robot, points);

  const bool was_limited = path.isLimited();
  path.limits = limitsAfter(path, m, points);
  if (was_limited || path.isLimited()) moved(world.fleet, robot);
  const std::uint32_t kept = std::max(path.first, m.first);
  if (!points.empty()) {
    path.points.resize(kept - path.first);
    path.points.insert(path.points.end(), points.begin() + (kept - m.first), points.end());
  }
  path.released = m.released;
  path.end = end.point;
  if (task.phase == Phase::kWaiting && task.segments.empty()) {
    const std::uint32_t next = path.origin + 1;
    if (next < path.released || next == path.size()) continuePath(world, robot);
  } else if (task.isOnRun()) {
    if (path.end > path.origin) path.extendRun();
    setRunEnd(world, obstacles, robot, alongRun(task, path.end));
  }
}

}  // namespace kiva
