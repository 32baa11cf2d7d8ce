// SPDX-License-Identifier: Apache-2.0
#include "plugins/motion.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/motion/driving/cruise.h"
#include "core/motion/driving/drives.h"
#include "core/motion/driving/self_location.h"
#include "core/motion/driving/speed_limits.h"
#include "core/motion/driving/stretches.h"
#include "core/motion/wheels/ground.h"
#include "core/sensing/room.h"
#include "core/state/progress/tasks.h"

namespace kiva {
namespace {

constexpr double kAlongGain = 10;       // speed a metre of lag [1/s]
constexpr double kHeadingGain = 8;      // yaw rate a radian of heading error [1/s]
constexpr double kLineGain = 8;         // yaw rate a metre off the line and m/s [rad/m²]
constexpr double kStuck = 0.15;         // lag behind the profile of a robot that is stuck [m]
constexpr double kSlid = 0.02;          // deviation from the profile that proves slip [m]
constexpr double kHeldSlid = 0.001;     // the same for a stopped robot [m]
constexpr double kLeastPlanned = 0.03;  // smallest planned acceleration, where nothing grips [m/s²]
constexpr double kMargin = 0.002;       // room beside a robot that backs to its goal [m]
constexpr double kRecoverSpeed = 0.3;   // speed on the way back to the grid [m/s]
constexpr double kSquare = 0.005;       // largest heading error at the end of a drive [rad]
// Largest speed of a robot at rest [m/s, rad/s]. No profile ends with it: acceleration · dt is
// round.
constexpr double kStill = 1.1e-4;

struct OnLine {
  double along;    // distance along the line, from the origin of the reference [m]
  double across;   // distance to the left of the line [m]
  double speed;    // speed along the line [m/s]
  double heading;  // heading relative to the line [rad]
};

/// Returns the robot's estimated place on that line.
OnLine onLine(const FleetState& f, int i, const MotionSegment& segment) {
  const double c = std::cos(segment.yaw), s = std::sin(segment.yaw);
  const PlanarPose at = f.believed(i);
  const double dx = at.x - segment.x, dy = at.y - segment.y;
  return {c * dx + s * dy, -s * dx + c * dy, c * f.vx[i] + s * f.vy[i], at.yaw - segment.yaw};
}

void begin(RobotView& world, int i, const OnLine& at) {
  FleetState& f = world.fleet;
  f.tasks[i].phase = Phase::kDriving;
  f.setProfile(i, {at.along, at.speed});
  f.reference_end[i] = f.tasks[i].segments.front().length;
  f.acceleration[i] = f.deceleration[i] = plannedAcceleration(world, i);
}

ReferenceMotion alongLine(const MotionSegment& segment, double top_speed, double acceleration) {
  return {std::cos(segment.yaw), std::sin(segment.yaw), 0, top_speed, acceleration};
}

bool arrived(const FleetState& f, int i, const OnLine& at) {
  return f.reference[i] == f.reference_end[i] &&
         std::abs(at.along - f.reference_end[i]) < kThereDistance && stands(f, i);
}

/// Ends a segment that the wheels can't drive, such as one into a wall that no laser saw.
bool giveUp(TaskView& world, int i, const OnLine& at) {
  FleetState& f = world.fleet;
  double& overdue = f.tasks[i].overdue;
  if (f.reference[i] == f.reference_end[i]) overdue += world.clock.dt;
  const double lag = std::abs(f.reference[i] - at.along);
  if (lag < kStuck && overdue < kOverdue) return false;
  haltRobot(world, i, "", "is stuck: its wheels turn or stall without getting it on");
  return true;
}

/// Returns the speed limit near people now, on the way down to the allowed speed [m/s].
double allowedSpeed(const Scene& world, int i) {
  const FleetState& f = world.fleet;
  const double allowed = f.allowed_speed[i], speed = std::abs(f.command(i).speed);
  if (speed <= allowed || f.robots[i].drive.acceleration == 0) return allowed;
  return std::max(allowed, speed - plannedBraking(world, i) * world.clock.dt);
}

/// Returns the heading error to correct. A robot at its goal leaves the error that the last code
/// showed to the next drive or turn: correcting it would take half a second a stop.
double headingToMend(const FleetState& f, int i, double heading) {
  const bool is_there = f.localises && f.reference[i] == f.reference_end[i];
  return is_there && std::abs(heading) < kSquare ? 0 : heading;
}

/// Drives the wheels at the reference's speed, corrects the lag behind it, and steers back onto the
/// line.
void followLine(FleetState& f, int i, const OnLine& at, double lag, double speed) {
  setWheels(f, i, speed + kAlongGain * lag,
            -kHeadingGain * headingToMend(f, i, at.heading) - kLineGain * at.speed * at.across);
}

/// Restarts the reference of a robot that slips, on a floor with slippery places, at the robot's
/// position, and halves the acceleration from there on.
void feelSlip(RobotView& world, int i, const OnLine& at) {
  FleetState& f = world.fleet;
  if (std::abs(f.reference[i] - at.along) < kSlid || f.acceleration[i] <= kLeastPlanned) return;
  if (!isPatchy(world)) return;
  f.acceleration[i] = f.deceleration[i] = std::max(kLeastPlanned, f.acceleration[i] / 2);
  f.setProfile(i, {at.along, at.speed});
}

/// Returns whether the robot is past its goal and still slides.
bool overshoots(const Scene& world, int i, const MotionSegment& segment, const OnLine& at) {
  const double sign = segment.reverse ? -1 : 1;
  return sign * (at.along - world.fleet.reference_end[i]) > kSlid && sign * at.speed > kStill &&
         isPatchy(world);
}

/// Ends a drive whose robot has slid past its goal and has no room to come back. Returns whether it
/// did.
bool isCutOff(TaskView& world, int i, double past) {
  const FleetState& f = world.fleet;
  if (isWayFree(world, i, f.believed(i), -past, kMargin)) return false;
  char text[80];
  std::snprintf(text, sizeof text, "slid %.2f m past its goal, and has no room to return", past);
  haltRobot(world, i, "", text);
  return true;
}

/// Stops where it can, and stays where it came to rest.
void holdDrive(RobotView& world, int i, const OnLine& at) {
  FleetState& f = world.fleet;
  if (f.tasks[i].phase == Phase::kStarting) return setWheels(f, i, 0, 0);
  const double lag = f.reference[i] - at.along;
  Profile command = f.command(i);
  if (command.speed != 0) {
    const bool at_once = f.robots[i].drive.acceleration == 0;
    const double braking = at_once ? 0 : plannedBraking(world, i);
    command.brake(braking, world.clock.dt, &f.tasks[i].stop_at);
  }
  f.follow(i, command);
  if (f.reference_speed[i] == 0 && std::abs(f.reference[i] - at.along) > kHeldSlid) {
    f.setProfile(i, {at.along, 0});
  }
  followLine(f, i, at, lag, f.reference_speed[i]);
  const bool is_there = std::abs(f.reference[i] - at.along) < kThereDistance && stands(f, i);
  if (f.reference_speed[i] == 0 && is_there) setWheels(f, i, 0, 0);
}

void driveSegment(TaskView& world, Obstacles& obstacles, int i) {
  FleetState& f = world.fleet;
  const Robot& r = f.robots[i];
  if (halting(world, i) || f.tasks[i].phase == Phase::kWaiting) return;
  const MotionSegment segment = f.tasks[i].segments.front();
  const bool begins = f.tasks[i].phase == Phase::kStarting && !isHeld(f, i);
  if (f.localises && begins) readCode(world, i, true);
  const OnLine at = onLine(f, i, segment);
  if (isHeld(f, i)) return holdDrive(world, i, at);
  if (f.tasks[i].phase == Phase::kStarting) {
    begin(world, i, at);
    setWheels(f, i, 0, 0);
    return;  // the laser looks first
  }
  if (arrived(f, i, at)) {
    setWheels(f, i, 0, 0);
    finishSegment(world, i);
    // Seen from where it believes to be, a robot that missed the code here may never find its way
    // free.
    if (f.localises && f.tasks[i].isHeldUp()) readCode(world, i, true);
    return;
  }
  if (overshoots(world, i, segment, at)) {  // its motors hold it, wherever it stops
    f.setProfile(i, {at.along, 0});
    return setWheels(f, i, 0, 0);
  }
  feelSlip(world, i, at);
  if (giveUp(world, i, at)) return;
  const double lag = f.reference[i] - at.along;
  const double past = segment.reverse ? 0 : f.reference[i] - f.reference_end[i];
  if (past > kSlid && stands(f, i) && isCutOff(world, i, past)) return;
  const bool backs = past > 0;
  const bool is_sure = segment.on_grid && !backs && !(f.localises && f.localisation[i].lost);
  const double usual = is_sure ? r.drive.speed : std::min(r.drive.speed, kRecoverSpeed);
  const double top = std::min({usual, allowedSpeed(world, i), permittedSpeed(world, i)});
  const bool exact = f.localises ? segment.on_grid && isOnCourse(lag, at.heading, at.across)
                                 : isExact(lag) && isExact(at.heading) && isExact(at.across);
  if (exact && !segment.reverse && !backs && holdsSpeed(world, i, top) &&
      tryCruise(world, obstacles, i, alongLine(segment, top, f.acceleration[i]))) {
    return;
  }
  Profile command = f.command(i);
  command.advance(f.reference_end[i], top, f.acceleration[i], f.deceleration[i], world.clock.dt);
  f.follow(i, command);
  followLine(f, i, at, lag, f.reference_speed[i]);  // the reference before this step
}

}  // namespace

void MotionPlugin::configure(Robot& robot, const Parameters& p) const {
  DriveParameters& d = robot.drive;
  const std::string drive = p.text("drive", "traction");
  if (drive != "traction" && drive != "jointed") {
    throw DescriptionError(p.where() + ": <drive> is '" + drive +
                           "'; traction or jointed was expected");
  }
  d.drive = drive == "jointed" ? Drive::kJointed : Drive::kTraction;
  d.motionFields(d, p.reader());
  d.emergency_deceleration = std::max(d.acceleration, d.emergency_deceleration);
  robot.has_motion = true;
}

void MotionPlugin::control(ContactView& world) const {
  for (int i : world.schedule.stepped_singly) {
    if (world.fleet.tasks[i].isAt(MotionSegment::Kind::kDrive))
      driveSegment(world, world.obstacles, i);
  }
}

void setWheels(FleetState& f, int i, double speed, double yaw_rate) {
  const DriveParameters& d = f.robots[i].drive;
  DriveSizes sizes{{d.wheel_radius, d.wheel_radius}, d.wheel_separation};
  if (f.localises) sizes = f.localisation[i].believed;
  const double turn = yaw_rate * sizes.separation / 2;
  f.wheel_target[0][i] = (speed - turn) / sizes.radius[0];
  f.wheel_target[1][i] = (speed + turn) / sizes.radius[1];
}

bool stands(const Fleet& f, int i) {
  return std::hypot(f.vx[i], f.vy[i]) < kStill && std::abs(f.yaw_rate[i]) < kStill;
}

bool halting(TaskView& world, int i) {
  FleetState& f = world.fleet;
  if (f.tasks[i].phase != Phase::kHalting) return false;
  Task& task = f.tasks[i];
  const bool drives = task.isAt(MotionSegment::Kind::kDrive) && !task.segment()->reverse;
  if (f.localises && f.localisation[i].lost && drives && f.reference_speed[i] != 0) {
    Profile command = f.command(i);  // without scans it relies on its wheels, which must not slide
    command.brake(plannedBraking(world, i), world.clock.dt, &task.stop_at);
    f.follow(i, command);
    setWheels(f, i, f.reference_speed[i], 0);
    return true;
  }
  setWheels(f, i, 0, 0);
  if (stands(f, i)) endStop(world, i);
  return true;
}

}  // namespace kiva
