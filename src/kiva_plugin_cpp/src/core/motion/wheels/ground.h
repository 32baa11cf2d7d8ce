// SPDX-License-Identifier: Apache-2.0
//
// The ground of robots: the floor, and areas of it with another friction.
#pragma once

#include "core/motion/wheels/vehicle.h"
#include "core/state/views/scene.h"

namespace kiva {

/// The file name by which a world asks for a patch of floor with a friction of its own.
constexpr char kFloorPatchPlugin[] = "libkiva_floor_patch.so";

/// Reads a patch. Throws DescriptionError.
FloorPatch readFloorPatch(const Parameters& parameters);

/// Returns the ground outside of all patches.
Ground groundOf(const Scene& world);
/// Returns whether friction differs between parts of the floor.
bool isPatchy(const Scene& world);
/// Returns the ground under the robot's wheels.
Ground groundUnder(const Scene& world, int robot);
/// Returns the friction that a robot may rely on until its reference has come to its goal: that of
/// the floor as built, which it knows, without temporary slipperiness.
double knownFriction(const Scene& world, int robot);
/// Returns the most slippery ground under its wheels until its reference has come to its goal.
Ground groundAhead(const Scene& world, int robot);

}  // namespace kiva
