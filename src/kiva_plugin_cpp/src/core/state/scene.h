// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/obstacles.h"
#include "core/physics/physics.h"
#include "core/state/clock.h"
#include "core/state/fallen_items.h"
#include "core/state/fleet_state.h"
#include "core/state/floor_state.h"
#include "core/state/model_table.h"
#include "core/state/people.h"
#include "core/state/settings.h"
#include "core/state/storage.h"

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
