// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/obstacles.h"
#include "core/physics/physics.h"
#include "core/state/floor/fallen_items.h"
#include "core/state/floor/floor_state.h"
#include "core/state/floor/storage.h"
#include "core/state/models/jointed_bodies.h"
#include "core/state/models/model_table.h"
#include "core/state/people/people.h"
#include "core/state/robots/fleet_state.h"
#include "core/state/world/clock.h"
#include "core/state/world/plugins.h"
#include "core/state/world/settings.h"
#include "core/state/world/step_schedule.h"

namespace kiva {

/// The world for reading. A function that takes a `const Scene&` changes nothing but what its other
/// parameters name. Each view adds the parts that its functions may write, and hides the const
/// member of the same name: RobotView, TaskView, MotionView, ContactView, ModelView, from the
/// narrowest to the widest. A function takes the narrowest that it needs.
struct Scene {
  const WorldSettings& settings;
  const Clock& clock;
  const FleetState& fleet;
  const Obstacles& obstacles;
  const ModelTable& models;
  const Storage& storage;
  const FloorState& floor;
  const Physics& physics;
  const People& people;
  const FallenItems& fallen;
  const StepSchedule& schedule;
  const Plugins& plugins;
  JointedBodies& jointed_bodies;  ///< A cache: reading a robot's mechanism may make it.
};

}  // namespace kiva
