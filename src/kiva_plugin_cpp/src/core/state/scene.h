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

/// What is where in a world, for reading. The views below it in the list of rooms are built on it:
/// each names what its room may write as well, and hides what is const here by that.
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
