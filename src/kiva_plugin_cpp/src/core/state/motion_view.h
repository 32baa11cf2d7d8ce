// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/event_log.h"
#include "core/state/jointed_bodies.h"
#include "core/state/report_link.h"
#include "core/state/scene.h"
#include "core/state/step_schedule.h"

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
