// SPDX-License-Identifier: Apache-2.0
//
// What robots drive on: the floor, and what on it is more slippery, or grips better.
#pragma once

#include "core/motion/wheels/vehicle.h"
#include "core/state/views/scene.h"

namespace kiva {

/// The file name by which a world asks for a patch of floor with a friction of its own.
constexpr char kFloorPatchPlugin[] = "libkiva_floor_patch.so";

/// Throws DescriptionError.
FloorPatch readFloorPatch(const Parameters& parameters);

/// Returns the floor as it is where nothing is said of it.
Ground groundOf(const Scene& world);
/// Returns whether it is not the same everywhere.
bool isPatchy(const Scene& world);
/// Returns what the robot's wheels stand on.
Ground groundUnder(const Scene& world, int robot);
/// Returns what a robot may count on until its reference has come to its goal: the floor as it was
/// built, which it knows; not what is slippery for a time.
double knownFriction(const Scene& world, int robot);
/// Returns the most slippery of what they will have stood on when its reference has come to its
/// goal.
Ground groundAhead(const Scene& world, int robot);

}  // namespace kiva
