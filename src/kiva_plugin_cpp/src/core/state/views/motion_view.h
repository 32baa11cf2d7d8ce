// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/task_view.h"

namespace kiva {

/// Writes what moves: beside the robots with their tasks, models, and the obstacles that follow
/// them.
struct MotionView : TaskView {
  Obstacles& obstacles;
  ModelTable& models;
  StepSchedule& schedule;
};

}  // namespace kiva
