// SPDX-License-Identifier: Apache-2.0
//
// The state of a world: its parts, each with a header of its own.
#pragma once

#include <memory>

#include "core/state/chargers.h"
#include "core/state/command_link.h"
#include "core/state/inbox.h"
#include "core/state/model_view.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {

struct WorldState {
  explicit WorldState(const WorldDescription& description, const WorldOptions& options);
  ~WorldState();

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

  /// All of these that the rooms below `control` work on, each through the view of it that its room
  /// has.
  ModelView view;
};

/// The door for tests that look at what clients don't see.
WorldState& insideOf(World& world);
const WorldState& insideOf(const World& world);

}  // namespace kiva
