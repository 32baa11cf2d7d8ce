// SPDX-License-Identifier: Apache-2.0
#include "core/motion/driving/stretches.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/motion/driving/drives.h"
#include "core/motion/driving/self_location.h"

namespace kiva {
namespace {

constexpr double kMostLag = 0.002;       // [m, rad]
constexpr double kMostHeading = 0.02;    // [rad]
constexpr double kMostAcross = 0.03;     // [m]
constexpr double kMostMended = 0.005;    // [m/s] that motors correct in a step
constexpr double kMostYawRate = 0.1;     // [rad/s] likewise
constexpr double kSteering = 0.5;        // [m] on which it returns to its line, in two arcs;
constexpr double kLeastSteering = 0.15;  // [m]; on a shorter way it drives straight on
constexpr double kGentle = 0.05;    // [1/m]; tighter arcs are stretched to all the room there is,
constexpr double kNarrowest = 0.3;  // [1/m]; and even tighter ones are not driven
constexpr double kJustRead = 0.02;  // [m] by which a reading may move it back
constexpr double kTiny = 1e-9;      // [m]

/// The believed pose relative to a segment.
struct PoseOnLine {
  double along, across;  // [m]; across to the left
  double heading;        // [rad]
};

PoseOnLine onLine(const PlanarPose& at, const MotionSegment& segment) {
  const double c = std::cos(segment.yaw), s = std::sin(segment.yaw);
  const double dx = at.x - segment.x, dy = at.y - segment.y;
  return {c * dx + s * dy, c * dy - s * dx, at.yaw - segment.yaw};
}

/// Returns the distance along the segment at which the next code comes into view.
double nextCode(const WorldSettings& settings, double along) {
  const double cell = settings.grid_spacing;
  return std::ceil((along + kReadBefore + kJustRead) / cell) * cell - kReadBefore;
}

/// Sets the motion of chassis and wheels per unit of reference, by the robot's true properties.
void setMotion(FleetState& f, int i) {
  const Localisation& l = f.localisation[i];
  const DriveParameters& drive = f.robots[i].drive;
  const Stretch& stretch = l.stretch;
  const double aside = (stretch.turns ? 1 : stretch.curvature) * l.believed.separation / 2;
  double rolled[2];
  for (int wheel = 0; wheel < 2; ++wheel) {
    const double way = (stretch.turns ? 0 : 1) + (wheel == 0 ? -aside : aside);  // as believed
    f.per_wheel[wheel][i] = way / (l.believed.radius[wheel] * (1 + l.slip[wheel]));
    rolled[wheel] = f.per_wheel[wheel][i] * drive.wheel_radius;
  }
  const double ahead = stretch.turns ? 0 : (rolled[0] + rolled[1]) / 2;
  f.per_yaw[i] = (rolled[1] - rolled[0]) / drive.wheel_separation;
  // The chassis moves along the arc's chord, and so ends where the arc does.
  const double length = stretch.turns ? 0 : stretch.until - stretch.from;
  const double heading = f.yaw[i] + f.per_yaw[i] * length / 2;
  f.per_x[i] = ahead * std::cos(heading);
  f.per_y[i] = ahead * std::sin(heading);
}

/// Sets two arcs of half the length each that end on the line, along it.
void setArcs(Stretch* stretch, const PoseOnLine& at, double length) {
  stretch->curvature = -4 / (length * length) * (at.across + 0.75 * at.heading * length);
  stretch->next_curvature = -2 * at.heading / length - stretch->curvature;
  stretch->next_length = length / 2;
  stretch->until = stretch->from + length / 2;
}

double narrowest(const Stretch& stretch) {
  return std::max(std::abs(stretch.curvature), std::abs(stretch.next_curvature));
}

void steerBack(Stretch* stretch, const PoseOnLine& at, double room) {
  stretch->curvature = stretch->next_curvature = stretch->next_length = 0;
  stretch->until = stretch->from + room;
  if (room < kLeastSteering) return;
  setArcs(stretch, at, std::min(kSteering, room));
  if (narrowest(*stretch) > kGentle) setArcs(stretch, at, room);
  const double share = std::min(1.0, kNarrowest / std::max(kTiny, narrowest(*stretch)));
  stretch->curvature *= share;
  stretch->next_curvature *= share;
}

/// Returns the distance to the next code, to the goal, or to the point where it would be lost.
double roomAhead(const Scene& world, int i, double along) {
  const FleetState& f = world.fleet;
  const Localisation& l = f.localisation[i];
  const double to_code = nextCode(world.settings, along) - along;
  const double to_goal = std::max(kTiny, f.reference_end[i] - along);
  return std::min({to_code, to_goal, std::max(kTiny, l.lost_at - l.since_code)});
}

/// Adapts the deceleration to the goal, since the robot is not where it believed to be.
void brakeFor(RobotView& world, int i) {
  FleetState& f = world.fleet;
  if (f.acceleration[i] == 0) return;
  const Profile command = f.command(i);
  const double way = f.reference_end[i] - command.position, v = command.speed;
  const double needed = way > 0 ? v * v / (2 * std::max(way - v * world.clock.dt, kTiny)) : 0;
  const double usual = f.tasks[i].phase == Phase::kDriving ? f.acceleration[i] : f.deceleration[i];
  if (needed > usual) {
    f.deceleration[i] = std::min(needed, std::max(usual, plannedBraking(world, i)));
  } else {
    f.deceleration[i] = usual;
  }
}

/// Begins the next arc of the way back to the line. Returns false if no arc is left: the
/// robot drives straight on then.
bool nextArc(RobotView& world, int i, double along) {
  Stretch& stretch = world.fleet.localisation[i].stretch;
  if (stretch.next_length == 0) return false;
  stretch.curvature = stretch.next_curvature;
  stretch.until = along + std::min(stretch.next_length, roomAhead(world, i, along));
  stretch.next_length = stretch.next_curvature = 0;
  return true;
}

}  // namespace

bool isOnCourse(double lag, double heading, double across) {
  return std::abs(lag) < kMostLag && std::abs(heading) < kMostHeading &&
         std::abs(across) < kMostAcross;
}

bool keepsUpByEstimate(const FleetState& f, int i, bool turns) {
  const double v = f.reference_speed[i];
  const double c = std::cos(f.yaw[i]), s = std::sin(f.yaw[i]);
  const double ahead = turns ? 0 : v;
  return std::abs(c * f.vx[i] + s * f.vy[i] - ahead) < kMostMended &&
         std::abs(c * f.vy[i] - s * f.vx[i]) < kMostMended &&
         std::abs(f.yaw_rate[i] - (turns ? v : 0)) < kMostYawRate;
}

void beginStretch(RobotView& world, int i, bool turns) {
  FleetState& f = world.fleet;
  Localisation& l = f.localisation[i];
  Stretch& stretch = l.stretch;
  stretch = Stretch();
  if (turns) {
    stretch.turns = true;
    f.reference[i] = l.pose.yaw;
    stretch.until = std::numeric_limits<double>::infinity();
    drawSlip(world, i,
             std::max(0.1, std::abs(f.reference_end[i] - l.pose.yaw) * l.believed.separation / 2));
  } else {
    const PoseOnLine at = onLine(l.pose, f.tasks[i].segments.front());
    f.reference[i] = at.along;
    stretch.from = at.along;
    steerBack(&stretch, at, roomAhead(world, i, at.along));
    drawSlip(world, i, std::max(0.01, stretch.until - stretch.from));
    brakeFor(world, i);
  }
  stretch.from = f.reference[i];
  stretch.under_way = true;
  setMotion(world.fleet, i);
}

bool continueStretch(TaskView& world, int i) {
  FleetState& f = world.fleet;
  Localisation& l = f.localisation[i];
  Stretch& stretch = l.stretch;
  if (stretch.turns || f.reference[i] < stretch.until - kTiny) return true;
  l.settle(f.reference[i], f.wheel_angle[0][i], f.wheel_angle[1][i]);
  const std::uint32_t draws = l.draws;
  readCode(world, i, false);
  const bool looked = l.draws != draws;
  if (checkLost(world, i)) return false;
  const PoseOnLine at = onLine(l.pose, f.tasks[i].segments.front());
  f.reference[i] = stretch.from = at.along;
  if (looked) {
    steerBack(&stretch, at, roomAhead(world, i, at.along));
  } else if (!nextArc(world, i, at.along)) {
    stretch.curvature = 0;
    stretch.until = at.along + roomAhead(world, i, at.along);
  }
  drawSlip(world, i, std::max(0.01, stretch.until - stretch.from));
  brakeFor(world, i);
  stretch.under_way = true;
  setMotion(world.fleet, i);
  return f.reference_end[i] > f.reference[i];
}

}  // namespace kiva
