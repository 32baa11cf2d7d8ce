// SPDX-License-Identifier: Apache-2.0
//
// Loads robots with storage units, and unloads them.
#pragma once

#include "core/state/views/contact_view.h"

namespace kiva {

/// Puts the unit on the robot as its load.
void takeUp(ContactView& world, int robot, int unit);
/// Puts the robot's unit on the floor, upright beneath its present pose.
void putDown(ContactView& world, int robot);
/// Takes the load off the robot; the unit itself stays as it is.
void unload(ContactView& world, int robot);

/// Returns how far the centre of mass of the unit with its items lies beyond the plate on which it
/// would stand if the robot took it up now [m]; negative: it lies within.
double overhang(const Scene& world, int robot, int unit);

/// Adds the mass of an item [kg] to the unit; negative: removes it.
void addMass(ContactView& world, int unit, double mass);
/// Returns the mass of all its links [kg].
double massOf(const ModelDescription& description);

}  // namespace kiva
