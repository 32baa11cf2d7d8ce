// SPDX-License-Identifier: Apache-2.0
//
// The fleet as the world itself sees it: beside what clients see, what each robot is at, the
// reference that its drive follows, and until when its way is known to be free.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "core/estimation/localisation.h"
#include "core/state/robots/profile.h"
#include "core/state/robots/released_path.h"
#include "kiva_plugin_cpp/fleet.h"
#include "kiva_plugin_cpp/realism.h"

namespace kiva {

/// One thing a robot does at a time; a command is a row of them.
struct MotionSegment {
  enum class Kind : std::uint8_t { kTurn, kDrive, kRaise, kLower };
  Kind kind = Kind::kTurn;
  double x = 0;                    ///< Drive: a point of its line, in world [m],
  double y = 0;                    ///< from which the reference is measured.
  double goal = 0;                 ///< Drive: where on the line it ends, seen from there [m].
  double yaw = 0;                  ///< Turn, drive: heading in world, unwrapped [rad].
  bool reverse = false;            ///< Drive: backwards, against the heading.
  bool on_grid = true;             ///< Drive: along a grid line.
  int unit = -1;                   ///< Raise, lower: index of the storage unit.
  State state = State::kRotating;  ///< What the robot reports meanwhile.
};

/// What a robot is at, and what ends it.
enum class Phase : std::uint8_t {
  kIdle,       ///< Without a command. Ends with the next one.
  kStarting,   ///< The next control step begins the first segment.
  kTurning,    ///< Ends at the segment's heading.
  kDriving,    ///< Ends at the segment's goal.
  kLifting,    ///< The tower raises or lowers the unit. Ends when it has.
  kWaiting,    ///< Stands on its path. Ends with a release, or, with a segment, when that is free.
  kBraking,    ///< Drives on to a stop before an obstacle. Ends standing: BLOCKED.
  kHalting,    ///< With locked wheels. Ends standing: BLOCKED.
  kAbandoning  ///< Gives up a lift: the tower comes down. Ends with it down: BLOCKED.
};

/// What a robot's laser saw ahead at one scan on a drive.
struct Sighting {
  bool taken = false;   ///< False: nothing has been looked for on this segment yet.
  double distance = 0;  ///< From the robot's centre along its heading [m]; +inf = free.
  int model = -1;       ///< What it is: index in the world's models.
  bool faces = false;   ///< A face across the way: it can be measured again.
  double along = 0;     ///< Where on the segment the robot was [m].
};

/// What one robot is asked for, and what has become of it.
struct Task {
  Phase phase = Phase::kIdle;
  std::uint32_t command = 0;           ///< The number of the last command; 0 = none yet.
  std::string goal;                    ///< What it asked for, for a person.
  std::deque<MotionSegment> segments;  ///< The command's, the first under way.
  ReleasedPath path;                   ///< What its segments are made of, one by one, if it is one.
  bool cancelled = false;              ///< It ends with the present segments.
  double overdue = 0;                  ///< Since its reference ended without it being there [s].
  double stop_at = Profile::kNowhere;  ///< Held: where its reference comes to rest.
  Sighting sighting, last_sighting;    ///< The newest, and the one before.
  std::string blocked_by;              ///< A model's name, or empty.
  std::string blocked_reason;          ///< Why, for a person.
  int reported_shelf = -1;  ///< The unit's number in the last status; -1 = none was made yet.

  bool drives() const { return phase == Phase::kDriving || phase == Phase::kBraking; }
  /// Stands on its path before something that is in the way.
  bool isHeldUp() const { return phase == Phase::kWaiting && !segments.empty(); }
  bool follows() const { return path.isUnderWay(); }
  /// Its segment is a run of its path.
  bool isOnRun() const {
    return follows() && isAt(MotionSegment::Kind::kDrive) && segments.front().on_grid;
  }
  /// Its command is to end in BLOCKED.
  bool isStopping() const { return phase >= Phase::kBraking; }
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

/// A battery, and what its robot was like when its energy was reckoned last.
struct Battery {
  double energy = -1;              ///< [J]; -1 = not known yet.
  double wheel_angle[2] = {0, 0};  ///< [rad]
  double kinetic = 0;              ///< [J]
  double tower = 0;                ///< [m]
};

/// How motors follow the speeds that they are commanded: v' = v + share · (command - v) a step, a
/// first-order lag. Their way then stays behind the command's by `behind` · v.
struct MotorLag {
  double share = 1;   ///< 1 = at once.
  double behind = 0;  ///< [s]

  bool isNone() const { return share == 1; }
};

/// How a robot's load leans over the edge of what it stands on.
struct Sway {
  double tilt = 0, rate = 0;  ///< [rad, rad/s]
  double to_x = 0, to_y = 0;  ///< Where to: a unit vector in world.
  double vx = 0, vy = 0;      ///< The robot's velocity [m/s] after step number
  std::uint64_t step = 0;
};

/// The newest of what a robot has reported that came through.
struct Heard {
  std::uint64_t number = 0;  ///< The report's number, from 1; 0 = none yet.
  RobotReport report;
};

struct FleetState : Fleet {
  std::vector<Task> tasks;
  Column<double> wheel_target[2];  ///< Left, right: what the motors are asked for [rad/s].
  Column<std::uint8_t> awake;      ///< 0 = at rest without a command: costs nothing.
  Column<Battery> battery;
  Column<Sway> sway;               ///< Where loads may tip.
  Column<Heard> heard;             ///< Where reports go by radio.
  Column<std::uint8_t> activated;  ///< 1 = stepped by Bullet, since something is near.

  // The reference of the current segment: [m] along the heading, [rad], or [m] of tower.
  Column<double> reference, reference_speed;
  Column<double> command_speed;  ///< Where wheels lag: the command that the reference follows.
  MotorLag lag;
  Column<double> goal;          ///< Where it is to end.
  Column<double> deceleration;  ///< With which it is to end.

  /// Step up to which nothing can come near the robot, as long as it moves as it does. As a number
  /// that is compared with others several at a time.
  Column<double> clear_until;
  /// Step at which a robot that cruises needs a look again: that one, or when it may have come to
  /// or left the next point of a path.
  Column<double> attend_at;
  /// Step up to which a robot that found no way back to the grid looks for none again.
  Column<double> wedged_until;
  /// Where its reference comes to that next point, or leaves it [m]; infinity: nowhere. Kept while
  /// it cruises.
  Column<double> count_at;

  // Robots that follow their references exactly, see core/motion/driving/cruise.h.
  Column<std::int64_t> cruising;           ///< -1 = is one, 0 = is none: a mask.
  Column<double> per_x, per_y, per_yaw;    ///< What a unit of reference moves the chassis,
  Column<double> per_wheel[2];             ///< and its wheels.
  Column<double> top_speed, acceleration;  ///< The reference's.

  /// Whether robots drive by where they believe to be; if not, they know, and the next is empty.
  bool localises = false;
  std::vector<Localisation> localisation;

  /// The top speed of the fastest robot that the fleet ever had [m/s].
  double fastest = 0;

  /// Takes in what of realism robots drive by, at that step size [s].
  void applyRealism(const Realism& realism, double dt);

  /// Returns where robot `i` believes to be.
  PlanarPose believed(int i) const {
    if (!localises) return {x[i], y[i], yaw[i]};
    return localisation[i].at(reference[i]);
  }

  Profile profile(int i) const { return {reference[i], reference_speed[i]}; }
  void setProfile(int i, const Profile& profile) {
    reference[i] = profile.position;
    reference_speed[i] = command_speed[i] = profile.speed;
  }
  /// Returns what the wheel motors are commanded, which the reference follows.
  Profile command(int i) const {
    if (lag.isNone()) return profile(i);
    return {reference[i] + lag.behind * reference_speed[i], command_speed[i]};
  }
  /// The reference is one step later what motors make of that command.
  void follow(int i, const Profile& command);

  /// Appends a robot at rest and returns its index.
  int add(Robot robot, double x, double y, double yaw);
  /// Removes robot `i`; the last one takes its index.
  void remove(int i);
};

/// Returns whether wheels, or the tower if that is what it moves, are to stand: it is stopped, or
/// broken.
bool isHeld(const FleetState& fleet, int i);

/// Wakes robot `i` and ends its cruise, since a command, a push or another load changes its motion;
/// it looks around before it goes on. Every change of a robot's motion calls this, and needs
/// nothing else.
void moved(FleetState& fleet, int i);

}  // namespace kiva
