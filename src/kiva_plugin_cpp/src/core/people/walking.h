// SPDX-License-Identifier: Apache-2.0
//
// People who walk: from waypoint to waypoint, and not into anything.
#pragma once

#include "core/state/contact_view.h"

namespace kiva {

/// As World::walk and World::people say.
void walk(ContactView& world, People& people, const std::string& person, const Walk& walk);
std::vector<Person> peopleIn(const Scene& world);

/// A model that has just come is an actor, who walks so.
void beginScript(ContactView& world, People& people, int model, const Walk& script);
/// Actors begin anew, everybody else is no person any more.
void restartScripts(FleetState& fleet, People& people);
/// A step of time goes by.
void walkOn(ContactView& world, People& people);

}  // namespace kiva
