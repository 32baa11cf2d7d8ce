// SPDX-License-Identifier: Apache-2.0
#include "core/people/protective_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/control/interruptions.h"
#include "core/motion/driving/drives.h"
#include "core/sensing/scans.h"
#include "core/state/places/footprints.h"

namespace kiva {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMargin = 0.15;      // [m] ahead of the point where the robot stops
constexpr double kTurnMargin = 0.05;  // [m] around its turning circle
constexpr double kBeside = 2;         // [m] from the reach of any robot's corners
constexpr double kCreep = 0.05;       // [m/s]; a robot that may only be slower stops,
constexpr double kSetOff = 0.15;      // [m/s] and starts again from this speed on
constexpr int kHalvings = 20;         // steps of the search for a speed, to a micrometre a second

/// The reaction time and deceleration of a robot that stops.
struct Braking {
  double reaction = 0;      // time before it brakes [s]
  double deceleration = 0;  // [m/s²]; +inf = stops at once
  double way(double speed) const { return speed * reaction + speed * speed / (2 * deceleration); }
  double time(double speed) const { return reaction + speed / deceleration; }
};

/// A person relative to a driving robot.
struct Seen {
  double ahead = 0;   // distance ahead of its front [m]
  double beside = 0;  // distance from its sides [m]; 0 = within its lane
  double radius = 0;  // [m]
  /// Returns the distance of the person from the area that the robot sweeps within `way` [m];
  /// negative: they overlap.
  double distance(double way) const {
    const double along = ahead < 0 ? -ahead : std::max(0.0, ahead - way);
    return std::hypot(along, beside) - radius;
  }
};

/// Returns whether the robot stops before it can touch a person walking towards it (ISO 13855).
bool isSafe(const Seen& person, const Braking& braking, double speed) {
  return person.distance(braking.way(speed) + kMargin) >= kMostWalkingSpeed * braking.time(speed);
}

/// Returns the highest safe speed up to `top` [m/s]; +inf if `top` is safe.
double safeSpeed(const Seen& person, const Braking& braking, double top) {
  if (isSafe(person, braking, top)) return kInfinity;
  double low = 0, high = top;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = (low + high) / 2;
    (isSafe(person, braking, middle) ? low : high) = middle;
  }
  return low;
}

Braking brakingOf(const Scene& world, int robot) {
  const Robot& r = world.fleet.robots[robot];
  const double period = static_cast<double>(scanPeriod(world.clock, r) + 1) * world.clock.dt;
  const bool at_once = r.drive.acceleration == 0;
  return {period, at_once ? kInfinity : plannedBraking(world, robot)};
}

/// The way of a robot, which may be backwards along its heading.
struct Way {
  double yaw = 0;  // [rad]
  bool reverse = false;
};

Way wayOf(const FleetState& f, int robot) {
  if (f.tasks[robot].isSteered()) {
    const Steering& s = f.steering(robot);
    return {f.yaw[robot], s.asked.speed < 0 || s.command.speed < 0};
  }
  const MotionSegment& segment = f.tasks[robot].segments.front();
  return {segment.yaw, segment.reverse};
}

Seen seenFrom(const Scene& world, int robot, const Way& way, const Walker& walker) {
  const Robot& r = world.fleet.robots[robot];
  const double sign = way.reverse ? -1 : 1;
  const double c = sign * std::cos(way.yaw), s = sign * std::sin(way.yaw);
  const Vector3& at = world.models[walker.model]->pose.Pos();
  const double dx = at.X() - world.fleet.x[robot], dy = at.Y() - world.fleet.y[robot];
  return {c * dx + s * dy - halfLength(r), std::max(0.0, std::abs(c * dy - s * dx) - halfWidth(r)),
          walker.radius};
}

double whileDriving(const Scene& world, int robot, const Walker& walker) {
  const double top = world.fleet.robots[robot].drive.speed;
  const Seen person = seenFrom(world, robot, wayOf(world.fleet, robot), walker);
  return safeSpeed(person, brakingOf(world, robot), top);
}

/// Returns the distance beyond which a person does not limit the robot's speed [m].
double farthestOf(const Scene& world, int robot) {
  const Robot& r = world.fleet.robots[robot];
  const Braking braking = brakingOf(world, robot);
  return cornerRadius(r) + braking.way(r.drive.speed) + kMargin +
         kMostWalkingSpeed * braking.time(r.drive.speed);
}

bool isWithin(const Scene& world, int robot, const Walker& walker, double reach) {
  const Vector3& at = world.models[walker.model]->pose.Pos();
  const double dx = at.X() - world.fleet.x[robot], dy = at.Y() - world.fleet.y[robot];
  return dx * dx + dy * dy < (reach + walker.radius) * (reach + walker.radius);
}

/// Returns the speed allowed to a turning robot: 0 if the person is within reach of its corners.
double whileTurning(const Scene& world, int robot, const Walker& walker) {
  const double reach = cornerRadius(world.fleet.robots[robot]) + kTurnMargin;
  return isWithin(world, robot, walker, reach) ? 0 : kInfinity;
}

/// Returns whether it turns in place, or is to.
bool turnsInPlace(const FleetState& f, int robot) {
  const Task& task = f.tasks[robot];
  if (!task.isSteered()) return task.isAt(MotionSegment::Kind::kTurn);
  const Steering& s = f.steering(robot);
  return s.asked.speed == 0 && s.command.speed == 0;
}

double allowedSpeed(const Scene& world, int robot) {
  const Task& task = world.fleet.tasks[robot];
  if (!task.movesOnFloor() && !task.isSteered()) return kInfinity;
  const bool turns = turnsInPlace(world.fleet, robot);
  const double reach = farthestOf(world, robot);
  double least = kInfinity;
  for (const Walker& walker : world.people.walkers) {
    if (!isWithin(world, robot, walker, reach)) continue;
    least = std::min(
        least, turns ? whileTurning(world, robot, walker) : whileDriving(world, robot, walker));
  }
  const bool stands = world.fleet.allowed_speed[robot] == 0;
  return least < (stands ? kSetOff : kCreep) ? 0 : least;
}

/// Applies `change` to the robot's allowed speed, and lets the robot replan if it may go on.
template <typename Change>
void restrain(RobotView& world, int robot, Change change) {
  FleetState& f = world.fleet;
  const bool was_held = isHeld(f, robot);
  change();
  if (was_held && !isHeld(f, robot)) return replan(world, robot);
  if (f.awake[robot]) moved(f, robot);
}

void allow(RobotView& world, int robot, double speed) {
  double& allowed = world.fleet.allowed_speed[robot];
  if (speed != allowed) restrain(world, robot, [&] { allowed = speed; });
}

/// Holds turns immediately, since a turn is over before the next scan.
void holdTurns(RobotView& world) {
  const FleetState& f = world.fleet;
  for (const Walker& walker : world.people.walkers) {
    for (int i = 0; i < f.size(); ++i) {
      if (!isWithin(world, i, walker, kBeside)) continue;
      const bool turns = turnsInPlace(f, i);
      if (turns && whileTurning(world, i, walker) == 0) allow(world, i, 0);
    }
  }
}

// --- light curtains

bool isInterrupted(const Scene& world, const LightCurtain& curtain) {
  return std::any_of(world.people.walkers.begin(), world.people.walkers.end(),
                     [&](const Walker& walker) {
                       const Vector3& at = world.models[walker.model]->pose.Pos();
                       const double dx = at.X() - std::clamp(at.X(), curtain.min_x, curtain.max_x);
                       const double dy = at.Y() - std::clamp(at.Y(), curtain.min_y, curtain.max_y);
                       return std::hypot(dx, dy) < walker.radius;
                     });
}

/// Returns whether a part of the robot or its load may be inside.
bool reachesInto(const FleetState& f, int robot, const LightCurtain& curtain) {
  const Robot& r = f.robots[robot];
  const double c = std::abs(std::cos(f.yaw[robot])), s = std::abs(std::sin(f.yaw[robot]));
  const double hx = c * halfLength(r) + s * halfWidth(r), hy = s * halfLength(r) + c * halfWidth(r);
  return f.x[robot] + hx > curtain.min_x && f.x[robot] - hx < curtain.max_x &&
         f.y[robot] + hy > curtain.min_y && f.y[robot] - hy < curtain.max_y;
}

void watchCurtains(RobotView& world) {
  std::vector<const LightCurtain*> interrupted;
  for (const LightCurtain& curtain : world.people.curtains) {
    if (isInterrupted(world, curtain)) interrupted.push_back(&curtain);
  }
  for (int i = 0; i < world.fleet.size(); ++i) {
    const bool stands = std::any_of(
        interrupted.begin(), interrupted.end(),
        [&](const LightCurtain* curtain) { return reachesInto(world.fleet, i, *curtain); });
    std::uint8_t& curtained = world.fleet.curtained[i];
    if (stands != (curtained != 0)) restrain(world, i, [&] { curtained = stands; });
  }
}

}  // namespace

void applyProtectiveFields(RobotView& world, People& people, const std::vector<int>& scans_due) {
  if (!people.slowsRobots()) return;
  if (people.walkers.empty()) {
    for (int i = 0; i < world.fleet.size(); ++i) allow(world, i, kInfinity);
  } else {
    for (int i : scans_due) allow(world, i, allowedSpeed(world, i));
  }
  holdTurns(world);
  watchCurtains(world);
  people.field_was_occupied = !people.walkers.empty();
}

void setLightCurtain(People& people, const LightCurtain& curtain) {
  if (curtain.name.empty()) throw std::invalid_argument("a light curtain needs a name");
  const auto are_edges = [](double min, double max) {
    return std::isfinite(min) && std::isfinite(max) && min < max;
  };
  if (!are_edges(curtain.min_x, curtain.max_x) || !are_edges(curtain.min_y, curtain.max_y)) {
    throw std::invalid_argument("light curtain '" + curtain.name +
                                "': min_x < max_x and min_y < max_y, all finite, were expected");
  }
  removeLightCurtain(people, curtain.name);
  people.curtains.push_back(curtain);
}

bool removeLightCurtain(People& people, const std::string& name) {
  auto& curtains = people.curtains;
  const auto is_it = [&](const LightCurtain& curtain) { return curtain.name == name; };
  const auto end = std::remove_if(curtains.begin(), curtains.end(), is_it);
  const bool was_there = end != curtains.end();
  curtains.erase(end, curtains.end());
  return was_there;
}

}  // namespace kiva
