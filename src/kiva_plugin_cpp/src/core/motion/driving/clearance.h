// SPDX-License-Identifier: Apache-2.0
//
// Until when a robot's way is free: whether, wherever it may go within a short time, it can come
// near anything. FleetState::clear_until keeps the answer until the robot moves otherwise, so that
// one that stands need not be reckoned with as if it moved.
#pragma once

#include "core/state/views/motion_view.h"

namespace kiva {

/// Nearer than that Bullet decides [m]; less than what is between two that turn in adjacent cells.
constexpr double kNear = 0.004;
/// [m/s] of a chassis' corner in the fastest turn.
constexpr double kCornerSpeed = 3.2;

/// Returns for how long nothing can come near the robot [s]; 0 if that is no time worth speaking
/// of. `is_crowded` changes not what is found but how soon: where little is to be expected, little
/// is asked for first. Any thread, while nothing is changed.
double clearTime(const Scene& world, int robot, bool is_crowded);

/// Notes in clear_until what clearTime found. Returns false, with nothing noted, if that is 0.
bool noteClearance(MotionView& world, int robot, double time);

/// Looks for how long nothing can come near the robot, and notes it.
bool findClearance(MotionView& world, int robot, bool is_crowded);

/// Returns whether the way is free for long enough to cruise on it.
bool hasClearance(const Scene& world, int robot);

/// Finds what of others is near the footprints `own` of one model or robot, no point of which
/// goes faster than `speed` [m/s]: slots of models that it could touch in the next step go to
/// `close`. Returns the least gap to anything foreign, at most `reach`; both in [m].
double findClose(const Scene& world, const std::vector<Footprint>& own, double speed, double reach,
                 std::vector<int>* close);

/// Returns how fast any point of the robot may go within the next step [m/s].
double pointSpeed(const FleetState& fleet, int robot);

}  // namespace kiva
