// SPDX-License-Identifier: Apache-2.0
#include "core/motion/driving/clearance.h"

#include <algorithm>
#include <cmath>

#include "core/state/people/people.h"
#include "core/state/places/footprints.h"

namespace kiva {
namespace {

// Durations for which a way is tested [s].
constexpr double kHorizons[] = {0.3, 0.08, 0.02}, kShortest = kHorizons[2];
constexpr double kWorthwhile = 0.015;  // [s]; a shorter clearance is not worth a cruise
constexpr double kAstray = 0.001;      // [m] that a robot may be off its way at the horizon
constexpr double kPushed = 0.5;        // [m/s] by which a robot in Bullet may exceed its speed
constexpr double kStill = 1e-9;        // [m/s, rad/s]
constexpr double kWanders = 0.003;     // [m/s] of drift while turning with unequal wheels

bool standsStill(const FleetState& f, int i) {
  if (!f.awake[i]) return true;
  if (f.activated[i] || std::abs(f.vx[i]) > kStill || std::abs(f.vy[i]) > kStill ||
      std::abs(f.yaw_rate[i]) > kStill) {
    return false;
  }
  const Task& task = f.tasks[i];
  return !task.segment() || task.lifts();
}

/// Returns whether the robot's circle stays in place, or nearly, until its next segment, when it is
/// tested again.
bool turnsInPlace(const FleetState& f, int i) {
  const double most = f.localises ? kWanders : kStill;
  return !f.activated[i] && f.tasks[i].isAt(MotionSegment::Kind::kTurn) &&
         std::abs(f.vx[i]) < most && std::abs(f.vy[i]) < most;
}

/// Returns the largest speed at which its circle may approach [m/s].
double approachSpeed(const FleetState& f, int i) {
  if (turnsInPlace(f, i)) return f.localises ? kWanders : 0;
  const double speed = f.robots[i].drive.speed;
  return f.activated[i] ? std::max(speed, lengthOf(f.vx[i], f.vy[i]) + kPushed) : speed;
}

/// Returns the robot with its load as one upright box, in world.
Footprint boxOf(const Fleet& f, int i) {
  const Robot& r = f.robots[i];
  Footprint own;
  own.x = f.x[i];
  own.y = f.y[i];
  own.c = std::cos(f.yaw[i]);
  own.s = std::sin(f.yaw[i]);
  own.hx = halfLength(r);
  own.hy = halfWidth(r);
  own.z_max = heightOf(f, i);
  return own;
}

/// Returns the circle that contains the box at any heading.
Footprint turned(Footprint box) {
  box.kind = Footprint::Kind::kCircle;
  box.hx = lengthOf(box.hx, box.hy);
  return box;
}

/// Returns the area that a box covers while it moves by (dx, dy) [m] along its heading.
Footprint shifted(Footprint box, double dx, double dy) {
  box.x += dx / 2;
  box.y += dy / 2;
  box.hx += lengthOf(dx, dy) / 2;
  return box;
}

/// Returns the largest distance that the reference of a cruising robot covers in that time.
double wayWithin(const FleetState& f, int i, double time) {
  const double most = f.top_speed[i] * time;
  return std::clamp(f.reference_end[i] - f.reference[i], -most, most);
}

/// Returns whether a cruising robot turns in place.
bool cruisesInPlace(const FleetState& f, int i) { return f.per_x[i] == 0 && f.per_y[i] == 0; }

/// Returns the area that a robot covers while it follows its reference exactly.
Footprint cruiseSweep(const FleetState& f, int i, double time) {
  if (cruisesInPlace(f, i)) return turned(boxOf(f, i));
  const double way = wayWithin(f, i, time);
  return shifted(boxOf(f, i), f.per_x[i] * way, f.per_y[i] * way);
}

/// Returns the area that any other robot may cover, by its phase: a driving one may go either way.
Footprint sweep(const FleetState& f, int i, double time) {
  const Task& task = f.tasks[i];
  Footprint own = boxOf(f, i);
  own.hx += kAstray;
  own.hy += kAstray;
  if (!task.segment() || task.isAt(MotionSegment::Kind::kTurn)) own = turned(own);
  if (task.segment() && !task.isAt(MotionSegment::Kind::kDrive)) return own;
  own.hx += std::max(f.robots[i].drive.speed, lengthOf(f.vx[i], f.vy[i])) * time;
  return own;
}

/// Returns whether meets(footprint) is true for any footprint of a robot and its load. Stores
/// nothing, so that several threads may call it.
template <typename Meets>
bool anyOfRobot(const Scene& world, int robot, Meets meets) {
  const FleetState& f = world.fleet;
  const double c = std::cos(f.yaw[robot]), s = std::sin(f.yaw[robot]);
  const auto& own = world.obstacles.ofMover(robot);
  return std::any_of(own.begin(), own.end(), [&](const Footprint& local) {
    Footprint at = local;
    place(local, f.x[robot], f.y[robot], c, s, &at);
    return meets(at);
  });
}

/// Returns whether nothing comes near the area `swept`, which the robot covers within `time` [s].
bool isClear(const Scene& world, int robot, const Footprint& swept, double time) {
  const FleetState& f = world.fleet;
  Footprint lifted = swept;  // down to the floor
  lifted.z_min += world.floor.extent.z;
  lifted.z_max += world.floor.extent.z;
  const auto meets = [&](const Footprint& other) {
    const double reach = kNear + world.people.walkingSpeed(other.model) * time;
    return shareHeight(other, lifted) && mayBeWithin(reach, swept, other) &&
           gap(swept, other) < reach;
  };
  const auto approaches = [&](int i, double radius) {
    if (i == robot) return false;
    const bool still = standsStill(f, i);
    const double reach = kNear + (still ? 0 : approachSpeed(f, i)) * time;
    const Footprint circle = circleAt(f.x[i], f.y[i], radius);
    if (!mayBeWithin(reach, swept, circle) || gap(swept, circle) >= reach) return false;
    return !still || anyOfRobot(world, i, meets);
  };
  const double walk = world.people.walkers.empty() ? 0 : kMostWalkingSpeed * time;
  const double drive = std::max((world.fleet.fastest + kPushed) * time, walk);
  const double reach = radiusOf(swept) + kNear;
  return !world.obstacles.anyAround(swept.x, swept.y, {lifted.z_min, lifted.z_max}, reach + walk,
                                    reach + drive, meets, approaches);
}

/// Returns the part of the horizon in which a cruising robot stays within the slack of its obstacle
/// index.
double horizonOf(const FleetState& f, int i, double horizon) {
  if (f.cruising[i] == 0 || cruisesInPlace(f, i)) return horizon;
  return std::min(horizon, Obstacles::kSlack / std::max(1e-9, f.top_speed[i]));
}

/// Returns whether nothing can come near the robot within `time` [s].
bool isClearFor(const Scene& world, int i, double time) {
  const FleetState& f = world.fleet;
  return isClear(world, i, f.cruising[i] != 0 ? cruiseSweep(f, i, time) : sweep(f, i, time), time);
}

/// Returns the circle that contains all of them.
Footprint holding(const std::vector<Footprint>& all) {
  Footprint circle = circleAt(all.front().x, all.front().y, 0);
  for (const Footprint& footprint : all) {
    const double away = lengthOf(footprint.x - circle.x, footprint.y - circle.y);
    circle.hx = std::max(circle.hx, away + radiusOf(footprint));
  }
  return circle;
}

}  // namespace

double clearTime(const Scene& world, int i, bool is_crowded) {
  const FleetState& f = world.fleet;
  // With long steps the shorter horizons are one step, and nothing is indexed for longer.
  if (f.cruising[i] == 0 && kHorizons[1] < 2 * world.clock.dt) {
    for (const double horizon : {kHorizons[0], kShortest}) {
      if (isClearFor(world, i, horizon)) return horizon;
    }
    return 0;
  }
  // A hemmed-in robot tests at each step. A way that is clear for longer is clear for less.
  if (is_crowded && !isClearFor(world, i, horizonOf(f, i, kShortest))) return 0;
  for (const double horizon : kHorizons) {
    const double time = horizonOf(f, i, horizon);
    if ((is_crowded && horizon == kShortest) || isClearFor(world, i, time)) return time;
  }
  return 0;
}

bool noteClearance(RobotView& world, Obstacles& obstacles, int i, double time) {
  FleetState& f = world.fleet;
  if (time == 0) return false;
  if (f.cruising[i] != 0) {
    obstacles.follow(i, cruisesInPlace(f, i) ? 0 : std::abs(wayWithin(f, i, time)));
  }
  f.clear_until[i] = static_cast<double>(world.clock.total_steps) +
                     std::max(1.0, std::floor(time / world.clock.dt));
  return true;
}

bool findClearance(RobotView& world, Obstacles& obstacles, int i, bool is_crowded) {
  return noteClearance(world, obstacles, i, clearTime(world, i, is_crowded));
}

bool hasClearance(const Scene& world, int i) {
  const double left = world.fleet.clear_until[i] - static_cast<double>(world.clock.total_steps);
  return left * world.clock.dt >= kWorthwhile;
}

double pointSpeed(const FleetState& f, int i) {
  const Robot& r = f.robots[i];
  const double speed = lengthOf(f.vx[i], f.vy[i]) + std::abs(f.yaw_rate[i]) * cornerRadius(r);
  const bool at_once = r.drive.acceleration == 0 || r.drive.quarter_turn_time == 0;
  return at_once ? std::max(speed, r.drive.speed + kCornerSpeed) : speed;
}

double findClose(const Scene& world, const std::vector<Footprint>& all, double speed, double reach,
                 std::vector<int>* close) {
  if (all.empty()) return reach;
  const double farthest = kNear + (speed + world.fleet.fastest + kCornerSpeed) * world.clock.dt;
  const Footprint whole = holding(all);
  double least = reach;
  const auto compare = [&](const Footprint& own, const Footprint& other) {
    if (other.model == own.model || (own.group >= 0 && other.group == own.group)) return;
    if (!shareHeight(own, other) || !mayBeWithin(std::max(least, farthest), own, other)) return;
    const double distance = gap(own, other);
    least = std::min(least, distance);
    const bool is_robot = other.group >= 0 && other.group < world.fleet.size();
    const double theirs =
        is_robot ? pointSpeed(world.fleet, other.group) : world.people.walkingSpeed(other.model);
    if (distance < kNear + (speed + theirs) * world.clock.dt) close->push_back(other.model);
  };
  world.obstacles.near(whole.x, whole.y, whole.hx + reach, [&](const Footprint& other) {
    if (!mayBeWithin(std::max(least, farthest), whole, other)) return;
    for (const Footprint& own : all) compare(own, other);
  });
  return least;
}

}  // namespace kiva
