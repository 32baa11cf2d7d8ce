// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/obstacles.h"
#include "core/physics/physics.h"
#include "core/state/floor/fallen_items.h"
#include "core/state/floor/floor_state.h"
#include "core/state/floor/storage.h"
#include "core/state/models/model_table.h"
#include "core/state/people/people.h"
#include "core/state/robots/fleet_state.h"
#include "core/state/world/clock.h"
#include "core/state/world/settings.h"

namespace kiva {

/// What is where in a world, for reading. The views of the rooms add what a room may write: a
/// member of a view hides the const one of the same name here.
struct Scene {
  const Settings& settings;
  const Clock& clock;
  const FleetState& fleet;
  const Obstacles& obstacles;
  const ModelTable& models;
  const Storage& storage;
  const FloorState& floor;
  const Physics& physics;
  const People& people;
  const FallenItems& fallen;
};

}  // namespace kiva
