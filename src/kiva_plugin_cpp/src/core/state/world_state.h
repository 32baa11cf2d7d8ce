// SPDX-License-Identifier: Apache-2.0
//
// The state of a world: its parts, each with a header of its own, in rooms by subject. The rooms of
// core are functions over those parts. A room in this list includes only rooms above it, which
// scripts/check/includes verifies. src/README.md lists the rooms within these.
//   parallel       the threads that share loops
//   estimation     the Kalman filter by which a robot locates itself
//   state          the parts, and functions of them alone
//   sensing        scans, and obstacles ahead of a robot
//   motion         wheels on the floor, references that drives follow, clearance of ways
//   contact        which models Bullet steps, collisions, external forces
//   models         robots, storage units, items and others, added and removed
//   control        commands, and the routes that robots take for them
//   communication  the links by which commands reach robots and reports reach clients
//   people         persons who walk, and robots that keep a distance from them
//   disturbances   failures, batteries that run low, loads that tip, items that fall
//   checkpoint     the whole state as bytes, and back
#pragma once

#include <memory>

#include "core/state/floor/chargers.h"
#include "core/state/robots/command_link.h"
#include "core/state/robots/inbox.h"
#include "core/state/robots/shadows.h"
#include "core/state/views/model_view.h"
#include "core/state/world/origin.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {

struct WorldState {
  explicit WorldState(const WorldDescription& description, const WorldOptions& options);
  ~WorldState();

  WorldSettings settings;
  Clock clock;

  Physics physics;
  FleetState fleet;
  Obstacles obstacles{fleet};
  Storage storage;
  ModelTable models;
  JointedBodies jointed_bodies;
  FloorState floor;
  Scans scans;
  Plugins plugins;

  Inbox inbox;
  CommandLink command_link;
  ReportLink report_link;
  EventLog log{clock};

  ContactLog contact_log;
  FallenItems fallen;
  ExternalInputs external_inputs;
  FailureState failures;
  Chargers chargers;
  People people;
  Shadows shadows;
  StepSchedule schedule;
  CheckpointOrigin origin;

  /// The widest view; each function takes the narrowest that it needs (core/state/views).
  ModelView view;
};

/// Returns the world's state, for tests and for plugins that come with the world.
WorldState& insideOf(World& world);
const WorldState& insideOf(const World& world);

}  // namespace kiva
