// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/robots/report_link.h"
#include "core/state/views/robot_view.h"
#include "core/state/world/event_log.h"

namespace kiva {

/// Writes robots' tasks: beside the fleet, claims of storage units, reports and events.
struct TaskView : RobotView {
  Storage& storage;
  ReportLink& report_link;
  EventLog& log;
};

}  // namespace kiva
