// SPDX-License-Identifier: Apache-2.0
//
// How robots that are not told where they are find out: they are calibrated badly, roll, slip, read
// codes on the floor or miss them, and are lost at last. Their estimates are in core/state.
#pragma once

#include "core/state/motion_view.h"

namespace kiva {

/// [m] before a code's middle at which its reading is done: as soon as it is in view.
constexpr double kReadBefore = 0.04;

/// Of a robot that is new: what its calibration says of its wheels, and where it is put.
void calibrate(MotionView& world, int robot);
/// Somebody put the robot where it is now, and told it.
void relocate(MotionView& world, int robot);
/// After a step in which it did not cruise: what its wheels rolled, and codes that come into view.
void track(MotionView& world, int robot);
/// Looks at the floor. A code that is in view is read, or missed, once as it is passed; again if
/// the robot `stands` on it.
void readCode(MotionView& world, int robot, bool stands);
/// Draws the slip of its wheels on the next `length` [m].
void drawSlip(MotionView& world, int robot, double length);
/// Where it has gone too far without a code, it stops and says that it is lost. Returns whether.
bool checkLost(MotionView& world, int robot);

}  // namespace kiva
