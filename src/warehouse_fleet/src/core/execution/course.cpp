// SPDX-License-Identifier: Apache-2.0
#include "warehouse_fleet/course.h"

namespace fleet {

void Course::admit(Cell cell, double now, int heading) {
  phase_ = CoursePhase::kStanding;
  at = cell;
  cells = {cell};
  plan_is_stale = true;
  still_since = moved = now;
  run_heading = heading;
}

void Course::send() {
  if (phase_ == CoursePhase::kStanding) phase_ = CoursePhase::kSent;
}

void Course::refuse() {
  if (phase_ == CoursePhase::kSent) phase_ = CoursePhase::kRefused;
}

void Course::accept() {
  if (phase_ != CoursePhase::kWithdrawn) phase_ = CoursePhase::kDriving;
  refusals = 0;
  oldest = id;
}

void Course::withdraw() {
  phase_ = CoursePhase::kWithdrawn;
  plan.clear();
  plan_is_stale = true;
}

void Course::finish(Cell cell) {
  phase_ = CoursePhase::kStanding;
  at = cell;
  cells = {cell};
  reached = 1;
  left = 0;
  is_short = false;
  turning = kNowhere;
  blocked_since = -1;
}

}  // namespace fleet
