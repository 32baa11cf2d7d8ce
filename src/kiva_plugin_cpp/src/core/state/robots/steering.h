// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "core/estimation/localisation.h"

namespace kiva {

/// A speed ahead [m/s] and a turn rate to the left [rad/s].
struct DriveVelocity {
  double speed = 0, turn_rate = 0;

  bool isNone() const { return speed == 0 && turn_rate == 0; }
};

/// The state of a robot that a client drives by velocities.
struct Steering {
  int kiva_id = 0;
  DriveVelocity asked;    ///< What the client asked for last, within the robot's limits.
  double silence = 0;     ///< Time since then [s].
  DriveVelocity command;  ///< The motors' command, which follows `asked` at limited accelerations.
  DriveVelocity lagged;   ///< What the motors make of it; differs only if motors lag.
  double room = 0;        ///< Way ahead, up to a clearance before the obstacle seen last [m].
  int obstacle = -1;      ///< Its index in the world's models, where it may be gone; -1 = none.
  bool looks = false;     ///< It is to look ahead in this step, before a scan is due.
  double since_look = 0;  ///< Time since the last look [s].
  double approach = 0;    ///< Speed at which the obstacle itself came nearer [m/s].
  double curvature = 0;   ///< Curvature of the way on which that was measured [1/m],
  double measured = 0;    ///< way to the obstacle from there, less what it drove since [m],
  double since_measured = 0;  ///< and time since then [s].
  bool bumped = false;  ///< It was in a collision, and stands until the client asks it to stop.
  /// Pose in world, as the robot believes, of the frame in which its wheels count its way.
  PlanarPose origin;
  /// Error of the pose in world, for each share by which the wheels' separation is wrong.
  PlanarPose per_separation;

  /// Returns whether it stands, and has nothing to do until it is asked for a velocity.
  bool rests() const { return asked.isNone() && command.isNone() && lagged.isNone() && !bumped; }
};

/// The robots that clients drive, in the order in which they were handed over.
using Steerings = std::vector<Steering>;

}  // namespace kiva
