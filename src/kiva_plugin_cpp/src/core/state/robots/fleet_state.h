// SPDX-License-Identifier: Apache-2.0
//
// The fleet inside the world: besides the public fleet, each robot's task, the reference that its
// drive follows, and the time for which its way is free.
// `robot` is an index in the fleet, `kiva_id` the number in a robot's name. `unit` is an index
// among the storage units, `unit_id` the number in a unit's name, which messages call `shelf_id`.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "core/estimation/localisation.h"
#include "core/state/robots/profile.h"
#include "core/state/robots/released_path.h"
#include "core/state/robots/steering.h"
#include "kiva_plugin_cpp/fleet.h"
#include "kiva_plugin_cpp/realism.h"

namespace kiva {

/// One action of a robot; a command is a sequence of them.
struct MotionSegment {
  enum class Kind : std::uint8_t { kTurn, kDrive, kRaise, kLower };
  Kind kind = Kind::kTurn;
  double x = 0;                    ///< Drive: point of its line at which the reference is 0,
  double y = 0;                    ///< in world [m].
  double length = 0;               ///< Drive: distance of its end from that point [m].
  double yaw = 0;                  ///< Turn, drive: heading in world, unwrapped [rad].
  bool reverse = false;            ///< Drive: backwards, against the heading.
  bool on_grid = true;             ///< Drive: along a grid line.
  int unit = -1;                   ///< Raise, lower: index of the storage unit.
  State state = State::kRotating;  ///< The state that the robot reports during this segment.
};

/// The phase of a robot's task, and the event that ends it.
enum class Phase : std::uint8_t {
  kIdle,      ///< No command. Ends with the next one.
  kStarting,  ///< The next control step begins the first segment.
  kTurning,   ///< Ends at the segment's heading.
  kDriving,   ///< Ends at the segment's goal.
  kLifting,   ///< The tower raises or lowers the unit. Ends at its height.
  kWaiting,   ///< Stands on its path. Ends with a release, or with a free way if it has a segment.
  kBraking,   ///< Drives on to a stop before an obstacle. Ends standing: BLOCKED.
  kHalting,   ///< Brakes with locked wheels. Ends standing: BLOCKED.
  kAbandoning,  ///< Gives up a lift: the tower comes down. Ends with it down: BLOCKED.
  kSteered      ///< A client drives it by velocities. Ends when the client gives it back.
};

/// The nearest thing ahead in one scan of a robot on a drive.
struct Sighting {
  bool taken = false;   ///< False before the first scan on the segment.
  double distance = 0;  ///< Distance from the robot's centre along its heading [m]; +inf = free.
  int model = -1;       ///< Index in the world's models.
  bool faces = false;   ///< It is a face across the way, which can be measured again.
  double along = 0;     ///< The robot's distance along the segment [m].
};

/// The command of a robot and its progress.
struct Task {
  Phase phase = Phase::kIdle;
  std::uint32_t command = 0;           ///< Number of the last command; 0 = none yet.
  std::string request;                 ///< The command in words.
  std::deque<MotionSegment> segments;  ///< Segments left, the first under way.
  ReleasedPath path;                   ///< The path that the segments are taken from, if any.
  bool cancelled = false;              ///< It ends with the present segments.
  double overdue = 0;                  ///< Time since the reference ended short of its end [s].
  double stop_at = Profile::kNowhere;  ///< Position at which the reference of a stopped robot ends.
  Sighting sighting, last_sighting;    ///< The newest one, and the one before.
  std::string blocked_by;              ///< A model's name, or empty.
  std::string blocked_reason;          ///< The reason in words.
  int reported_unit_id = -1;           ///< Id of the unit in the last status; -1 = no status yet.

  bool drives() const { return phase == Phase::kDriving || phase == Phase::kBraking; }
  /// Returns whether it stands on its path before an obstacle.
  bool isHeldUp() const { return phase == Phase::kWaiting && !segments.empty(); }
  bool follows() const { return path.isUnderWay(); }
  /// Returns whether its segment is a run of its path.
  bool isOnRun() const {
    return follows() && isAt(MotionSegment::Kind::kDrive) && segments.front().on_grid;
  }
  /// Returns whether its command will end in BLOCKED.
  bool isStopping() const { return phase >= Phase::kBraking && !isSteered(); }
  bool isSteered() const { return phase == Phase::kSteered; }
  const MotionSegment* segment() const { return segments.empty() ? nullptr : &segments.front(); }
  bool isAt(MotionSegment::Kind kind) const {
    return !segments.empty() && segments.front().kind == kind;
  }
  bool lifts() const {
    return isAt(MotionSegment::Kind::kRaise) || isAt(MotionSegment::Kind::kLower);
  }
  bool movesOnFloor() const {
    return isAt(MotionSegment::Kind::kDrive) || isAt(MotionSegment::Kind::kTurn);
  }
};

/// A battery, and its robot's state when its energy was computed last.
struct Battery {
  double energy = -1;              ///< [J]; -1 = not known yet.
  double wheel_angle[2] = {0, 0};  ///< [rad]
  double kinetic = 0;              ///< [J]
  double tower = 0;                ///< [m]
};

/// The first-order lag of motors behind their commands: v' = v + share · (command - v) a step.
/// Their position then stays behind the command's by `behind` · v.
struct MotorLag {
  double share = 1;   ///< 1 = at once.
  double behind = 0;  ///< [s]

  bool isNone() const { return share == 1; }
};

/// The tilt of a robot's load over an edge of its support.
struct Sway {
  double tilt = 0, rate = 0;  ///< [rad, rad/s]
  double to_x = 0, to_y = 0;  ///< Direction of the tilt: a unit vector in world.
  double vx = 0, vy = 0;      ///< The robot's velocity [m/s] after step number `step`.
  std::uint64_t step = 0;
};

/// The newest report of a robot that has arrived.
struct Heard {
  std::uint64_t number = 0;  ///< The report's number, from 1; 0 = none yet.
  RobotReport report;
};

struct FleetState : Fleet {
  std::vector<Task> tasks;
  Column<double> wheel_target[2];  ///< Commands of the left and right motor [rad/s].
  Column<std::uint8_t> awake;      ///< 0 = at rest without a command, and skipped by a step.
  Column<Battery> battery;
  Column<Sway> sway;               ///< Empty unless loads may tip.
  Column<Heard> heard;             ///< Empty unless reports go by radio.
  Column<std::uint8_t> activated;  ///< 1 = stepped by Bullet, since something is near.

  // The reference of the current segment: [m] along the heading, [rad], or [m] of tower.
  Column<double> reference, reference_speed;
  Column<double>
      command_speed;  ///< Speed of the command that the reference follows, if wheels lag.
  MotorLag lag;
  Column<double> reference_end;  ///< Position at which the reference ends.
  Column<double> deceleration;   ///< Deceleration at the end of the reference.

  /// Step up to which nothing can come near the robot while its motion stays the same. A double, so
  /// that several are compared at a time.
  Column<double> clear_until;
  /// Step at which a robot that cruises needs attention: `clear_until`, or the earliest step at
  /// which it may have reached or left the next point of a path.
  Column<double> attend_at;
  /// Step before which a robot without a way back to the grid does not search again.
  Column<double> wedged_until;
  /// Reference at which a robot that cruises reaches or leaves the next point [m]; +inf = no point.
  Column<double> count_at;

  // Robots that follow their references exactly, see core/motion/driving/cruise.h.
  Column<std::int64_t> cruising;           ///< -1 = cruises, 0 = does not: a mask.
  Column<double> per_x, per_y, per_yaw;    ///< Motion of the chassis a unit of reference.
  Column<double> per_wheel[2];             ///< Rotation of the wheels a unit of reference.
  Column<double> top_speed, acceleration;  ///< Limits of the reference.

  /// Whether robots drive by estimated poses; otherwise `localisation` is empty.
  bool localises = false;
  std::vector<Localisation> localisation;

  Steerings steerings;  ///< One for each robot in the phase kSteered.

  /// Top speed of the fastest robot that the fleet has had [m/s].
  double fastest = 0;

  /// Applies the parts of realism that change driving, at step size `dt` [s].
  void applyRealism(const Realism& realism, double dt);

  /// Returns the pose that robot `i` believes to have.
  PlanarPose believed(int i) const {
    if (!localises) return {x[i], y[i], yaw[i]};
    return localisation[i].at(reference[i]);
  }

  /// Returns the steering of robot `i`, which is steered.
  Steering& steering(int i);
  const Steering& steering(int i) const;

  Profile profile(int i) const { return {reference[i], reference_speed[i]}; }
  void setProfile(int i, const Profile& profile) {
    reference[i] = profile.position;
    reference_speed[i] = command_speed[i] = profile.speed;
  }
  /// Returns the profile that is commanded to the wheel motors and that the reference follows.
  Profile command(int i) const {
    if (lag.isNone()) return profile(i);
    return {reference[i] + lag.behind * reference_speed[i], command_speed[i]};
  }
  /// Advances the reference by one step, as motors follow that command.
  void follow(int i, const Profile& command);

  /// Appends a robot at rest and returns its index.
  int add(Robot robot, double x, double y, double yaw);
  /// Removes robot `i`; the last one takes its index.
  void remove(int i);
};

/// Returns whether the robot holds its wheels, or its moving tower: it is stopped or broken.
bool isHeld(const FleetState& fleet, int i);

/// Wakes robot `i` and ends its cruise, since a command, a push or another load changes its motion;
/// it looks around before it goes on. Every change of a robot's motion calls this, and needs
/// nothing else.
void moved(FleetState& fleet, int i);

/// Prefetches tasks and lasers of the robots that follow at place `k` of a list. Those of a large
/// fleet lie apart: cache misses take most of the time of a loop that only looks at them.
inline void fetchTasksAhead(const FleetState& f, const std::vector<int>& robots, std::size_t k) {
  constexpr std::size_t kTask = 12, kSegment = 6;  // distance in robots
  if (k + kTask < robots.size()) {
    __builtin_prefetch(&f.tasks[robots[k + kTask]].segments);
    __builtin_prefetch(&f.robots[robots[k + kTask]].laser);
  }
  if (k + kSegment >= robots.size()) return;
  const Task& soon = f.tasks[robots[k + kSegment]];
  if (soon.segment()) __builtin_prefetch(soon.segment());
}

}  // namespace kiva
