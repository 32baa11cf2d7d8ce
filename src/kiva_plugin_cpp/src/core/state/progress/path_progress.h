// SPDX-License-Identifier: Apache-2.0
//
// Progress of robots on their paths: the present run, and the points that were reached and left.
#pragma once

#include "core/state/views/robot_view.h"

namespace kiva {

/// Returns the segment that begins at the path's origin, where the robot stands with the next point
/// released: a turn towards that point, or the drive to the run's end.
MotionSegment nextSegment(const Scene& world, int robot);

/// Returns the robot's distance along its segment, from the point (x, y) of the segment [m].
double alongSegment(const FleetState& fleet, int robot);
/// Returns the distance of a point of the path along the present run, from its origin [m].
double alongRun(const Task& task, std::uint32_t point);
/// Counts the points reached and left by a robot whose centre is `along` the present run [m].
void countPoints(RobotView& world, int robot, double along);
/// Returns the distance along the run at which one of these counts changes next; +inf = never.
double nextCount(const Scene& world, int robot);
/// Returns the points ahead at which the robot turns or stops, and the last one.
std::vector<PathPoint> pointsAhead(const FleetState& fleet, int robot);

}  // namespace kiva
