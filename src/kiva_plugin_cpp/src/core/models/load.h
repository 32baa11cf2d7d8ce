// SPDX-License-Identifier: Apache-2.0
//
// Puts storage units on robots, and takes them off.
#pragma once

#include "core/state/views/contact_view.h"

namespace kiva {

/// Puts the unit on the robot as its load.
void takeUp(ContactView& world, int robot, int unit);
/// Puts the robot's unit on the floor, upright beneath its present pose.
void putDown(ContactView& world, int robot);
/// Removes the load from the robot; the unit itself does not change.
void unload(ContactView& world, int robot);

/// Returns by how much the centre of mass of the unit with its items would lie beyond the plate if
/// the robot took it up now [m]; negative: within the plate.
double overhang(const Scene& world, int robot, int unit);

/// Adds the mass of an item [kg] to the unit; negative: removes it.
void addMass(ContactView& world, int unit, double mass);
/// Returns the mass of all links [kg].
double massOf(const ModelDescription& description);

}  // namespace kiva
