// SPDX-License-Identifier: Apache-2.0
//
// Clearance: the time in which a robot can't come near anything, wherever it may go.
// FleetState::clear_until keeps the result until the robot's motion changes, so that a standing
// robot is not treated as a moving one.
#pragma once

#include "core/state/views/motion_view.h"

namespace kiva {

/// Distance below which Bullet steps the models [m]; less than between robots that turn in adjacent
/// cells.
constexpr double kNear = 0.004;
/// Speed of a chassis' corner in the fastest turn [m/s].
constexpr double kCornerSpeed = 3.2;

/// Returns the time for which nothing can come near the robot [s]; 0 if it is very short.
/// `is_crowded` changes the order of the tests, not the result: short times come first. Callable
/// from any thread while nothing changes.
double clearTime(const Scene& world, int robot, bool is_crowded);

/// Sets clear_until by the result of clearTime. Returns false, with nothing changed, if that is 0.
bool noteClearance(RobotView& world, Obstacles& obstacles, int robot, double time);

/// Computes the clear time and sets clear_until.
bool findClearance(RobotView& world, Obstacles& obstacles, int robot, bool is_crowded);

/// Returns whether the way is free for long enough to cruise on it.
bool hasClearance(const Scene& world, int robot);

/// Appends to `close` the slots of models that a model or robot with the footprints `own` could
/// touch in the next step, if none of its points is faster than `speed` [m/s]. Returns the smallest
/// gap to others, at most `reach` [m].
double findClose(const Scene& world, const std::vector<Footprint>& own, double speed, double reach,
                 std::vector<int>* close);

/// Returns the largest speed of a point of the robot within the next step [m/s].
double pointSpeed(const FleetState& fleet, int robot);

}  // namespace kiva
