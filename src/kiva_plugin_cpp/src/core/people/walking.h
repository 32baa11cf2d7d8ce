// SPDX-License-Identifier: Apache-2.0
//
// Moves people from waypoint to waypoint, around obstacles.
#pragma once

#include "core/state/views/contact_view.h"

namespace kiva {

/// Implement World::walk and World::people.
void walk(ContactView& world, People& people, const std::string& person, const Walk& walk);
std::vector<Person> listPeople(const Scene& world);

/// Makes a model that was just spawned an actor with that script.
void beginScript(ContactView& world, People& people, int model, const Walk& script);
/// Restarts the scripts of actors; all other models stop being people.
void restartScripts(FleetState& fleet, People& people);
/// Moves all people by one step.
void stepPeople(ContactView& world, People& people);

}  // namespace kiva
