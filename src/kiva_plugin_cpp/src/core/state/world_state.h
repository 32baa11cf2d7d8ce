// SPDX-License-Identifier: Apache-2.0
//
// The state of a world: its parts, each with a header of its own.
#pragma once

#include <memory>

#include "core/geometry/obstacles.h"
#include "core/physics/physics.h"
#include "core/state/chargers.h"
#include "core/state/clock.h"
#include "core/state/command_link.h"
#include "core/state/contact_log.h"
#include "core/state/event_log.h"
#include "core/state/failure_state.h"
#include "core/state/fallen_items.h"
#include "core/state/fleet_state.h"
#include "core/state/floor_state.h"
#include "core/state/inbox.h"
#include "core/state/jointed_bodies.h"
#include "core/state/model_table.h"
#include "core/state/people.h"
#include "core/state/plugins.h"
#include "core/state/report_link.h"
#include "core/state/scans.h"
#include "core/state/settings.h"
#include "core/state/step_schedule.h"
#include "core/state/storage.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {

struct WorldState {
  explicit WorldState(const WorldDescription& description, const WorldOptions& options);
  ~WorldState();

  World* owner = nullptr;
  Settings settings;
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
  StepSchedule schedule;
};

/// The door for tests that look at what clients don't see.
WorldState& insideOf(World& world);
const WorldState& insideOf(const World& world);

}  // namespace kiva
