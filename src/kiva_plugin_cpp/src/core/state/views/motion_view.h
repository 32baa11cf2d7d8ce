// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/models/jointed_bodies.h"
#include "core/state/robots/report_link.h"
#include "core/state/views/scene.h"
#include "core/state/world/event_log.h"
#include "core/state/world/step_schedule.h"

namespace kiva {

/// What moving robots changes: the fleet, obstacles that follow it, which storage units robots
/// claim, and what is told of all that.
struct MotionView : Scene {
  FleetState& fleet;
  Obstacles& obstacles;
  Storage& storage;
  JointedBodies& jointed_bodies;
  StepSchedule& schedule;
  ReportLink& report_link;
  EventLog& log;
};

}  // namespace kiva
