// SPDX-License-Identifier: Apache-2.0
//
// A storage unit on a robot: how it gets there and off again, and what that makes of the robot.
#pragma once

#include "core/state/contact_view.h"

namespace kiva {

/// The unit now rests on the robot and loads it.
void takeUp(ContactView& world, int robot, int unit);
/// The unit stands on the floor again, upright beneath where it was.
void putDown(ContactView& world, int robot);
/// The robot is without its unit from now on, whatever becomes of that.
void unload(ContactView& world, int robot);

/// An item of that mass [kg] came onto the unit; negative: left it.
void addMass(ContactView& world, int unit, double mass);
/// Of all its links [kg].
double massOf(const ModelDescription& description);

}  // namespace kiva
