// SPDX-License-Identifier: Apache-2.0
//
// Where a robot is on its path: the run that it drives, and which points it has come to and left.
#pragma once

#include "core/state/views/motion_view.h"

namespace kiva {

/// From the path's origin, where the robot stands with the next point released: a turn towards
/// that one, or the drive to the run's end.
MotionSegment nextSegment(const Scene& world, int robot);

/// Returns where the robot is along its segment, seen from where that is measured from [m].
double alongSegment(const FleetState& fleet, int robot);
/// Returns where a point of the path lies along the present run, seen from its origin [m].
double alongRun(const Task& task, std::uint32_t point);
/// Counts what the robot has come to and left, its centre being `along` the present run [m].
void countPoints(MotionView& world, int robot, double along);
/// Returns where along the run that changes next; +inf = nowhere.
double nextCount(const Scene& world, int robot);
/// Returns the points that it has not come to yet where it is to turn, or stop so far, and the last
/// one.
std::vector<PathPoint> pointsAhead(const FleetState& fleet, int robot);

}  // namespace kiva
