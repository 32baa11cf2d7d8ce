// SPDX-License-Identifier: Apache-2.0
#include "core/disturbances/failures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/communication/reports.h"
#include "core/control/interruptions.h"
#include "core/disturbances/batteries.h"
#include "core/state/progress/tasks.h"
#include "core/state/world/random_stream.h"

namespace kiva {
namespace {

constexpr double kHour = 3600;  // [s]

const char* nameOf(Failure failure) {
  switch (failure) {
    case Failure::kMotor:
      return "its drive has no torque";
    case Failure::kLift:
      return "its lift is stuck";
    case Failure::kLaser:
      return "its laser is blind";
    case Failure::kRadio:
      return "its radio is lost";
    case Failure::kWheelSlip:
      return "its wheels slip";
  }
  return "";
}

int findRobot(const FleetState& fleet, int kiva_id) {
  const int robot = fleet.find(kiva_id);
  if (robot >= 0) return robot;
  throw std::invalid_argument("there is no robot kiva" + std::to_string(kiva_id));
}

void apply(FleetState& fleet, const Realism& realism, int robot, Failure failure) {
  fleet.failures[robot] |= bitOf(failure);
  if (failure != Failure::kWheelSlip) return;
  fleet.robots[robot].grip = realism.failures.slipping_grip;
}

void publishEvent(const Scene& world, EventLog& log, Event::Kind kind, int robot,
                  const std::string& text) {
  log.report(kind, world.fleet.robots[robot].name, "", text);
}

std::string within(double seconds) {
  if (std::isinf(seconds)) return "";
  char text[64];
  std::snprintf(text, sizeof text, "; repaired in %.0f s", seconds);
  return text;
}

/// Plans the robot's motion again with its present abilities; a robot at rest has nothing to plan.
void adapt(RobotView& world, int robot) {
  FleetState& f = world.fleet;
  const Phase phase = f.tasks[robot].phase;
  const bool moves = phase == Phase::kDriving || phase == Phase::kTurning;
  if (moves && !isHeld(f, robot)) replan(world, robot);
  if (f.awake[robot]) moved(f, robot);
}

void repairDefect(TaskView& world, const Defect& defect) {
  FleetState& f = world.fleet;
  const int robot = f.find(defect.kiva_id);
  const bool was_held = isHeld(f, robot);
  f.failures[robot] &= static_cast<std::uint8_t>(~bitOf(defect.failure));
  if (defect.failure == Failure::kWheelSlip) {
    f.robots[robot].grip = 1;
    adapt(world, robot);
  }
  if (was_held && !isHeld(f, robot)) replan(world, robot);
  publishEvent(world, world.log, Event::Kind::kRepaired, robot,
               std::string("repaired: ") + nameOf(defect.failure));
  if (defect.failure != Failure::kRadio) return;
  // Clients missed the status changes in the meantime.
  f.tasks[robot].reported_unit_id = -1;
  setStatus(world, robot, f.status[robot], f.state[robot]);
}

Failure drawFailure(const FailureRealism& r, double chance) {
  const double share[] = {r.motor, r.lift_stuck, r.laser_blind, r.radio_lost, r.wheel_slips};
  double left = chance * std::accumulate(std::begin(share), std::end(share), 0.0);
  int kind = 0;
  while (kind + 1 < kFailureKinds && left >= share[kind]) left -= share[kind++];
  return static_cast<Failure>(kind + static_cast<int>(Failure::kMotor));
}

void failAtRandom(TaskView& world, FailureState& failures, RandomStream& random) {
  const FailureRealism& realism = world.settings.realism.failures;
  const int robots = world.fleet.size();
  const int robot = std::min(robots - 1, static_cast<int>(random.uniform() * robots));
  const Failure failure = drawFailure(realism, random.uniform());
  const double repair = std::max(world.clock.dt, random.exponential(realism.repair_time));
  injectFailure(world, failures, world.fleet.robots[robot].id, failure, repair);
}

/// Repairs all defects for which is_meant(defect) holds, in order.
template <typename IsMeant>
void repairWhere(TaskView& world, FailureState& failures, IsMeant is_meant) {
  auto& defects = failures.defects;
  auto at = defects.begin();
  while ((at = std::find_if(at, defects.end(), is_meant)) != defects.end()) {
    const Defect defect = *at;
    at = defects.erase(at);
    repairDefect(world, defect);
  }
}

void repairDue(TaskView& world, FailureState& failures) {
  for (Defect& defect : failures.defects) defect.left -= world.clock.dt;
  repairWhere(world, failures, [](const Defect& defect) { return defect.left <= 0; });
}

}  // namespace

void injectFailure(TaskView& world, FailureState& failures, int kiva_id, Failure failure,
                   double repair_after) {
  const int robot = findRobot(world.fleet, kiva_id);
  if (!(repair_after >= 0 && std::isfinite(repair_after))) {
    throw std::invalid_argument("repair_after must be finite and at least 0 s");
  }
  if (nameOf(failure)[0] == 0) throw std::invalid_argument("there is no such failure");
  const double left = repair_after > 0 ? repair_after : HUGE_VAL;
  for (Defect& defect : failures.defects) {
    if (defect.kiva_id != kiva_id || defect.failure != failure) continue;
    defect.left = left;
    return;
  }
  publishEvent(world, world.log, Event::Kind::kFailed, robot, nameOf(failure) + within(left));
  failures.defects.push_back({kiva_id, failure, left, reportOf(world, robot)});
  apply(world.fleet, world.settings.realism, robot, failure);
  adapt(world, robot);
}

void repair(TaskView& world, FailureState& failures, int kiva_id) {
  const int robot = findRobot(world.fleet, kiva_id);
  if (world.fleet.failures[robot] & kEmptyBattery) swapBattery(world, robot);
  repairWhere(world, failures,
              [kiva_id](const Defect& defect) { return defect.kiva_id == kiva_id; });
}

std::optional<RobotReport> lastHeard(const Scene& world, const FailureState& failures, int robot) {
  if (world.settings.realism.radio.delaysReports() && world.fleet.heard[robot].number > 0) {
    return world.fleet.heard[robot].report;
  }
  if ((world.fleet.failures[robot] & bitOf(Failure::kRadio)) == 0) return std::nullopt;
  const int id = world.fleet.robots[robot].id;
  for (const Defect& defect : failures.defects) {
    if (defect.kiva_id == id && defect.failure == Failure::kRadio) return defect.last;
  }
  return std::nullopt;
}

void sampleFailures(TaskView& world, FailureState& failures) {
  if (!failures.defects.empty()) repairDue(world, failures);
  const FailureRealism& realism = world.settings.realism.failures;
  if (!realism.enabled || realism.per_robot_hour == 0 || world.fleet.size() == 0) return;
  const bool is_first = failures.count == 0;  // then only the time of the next failure is drawn
  failures.exposure -= is_first ? 0 : world.fleet.size() * world.clock.dt;
  if (failures.exposure > 0) return;
  RandomStream random(world.settings.options.seed, Matter::kFailure, 0, failures.count++);
  if (!is_first) failAtRandom(world, failures, random);
  failures.exposure = random.exponential(kHour / realism.per_robot_hour);
}

void drawFailuresAnew(TaskView& world, FailureState& failures, std::uint64_t number) {
  const FailureRealism& realism = world.settings.realism.failures;
  if (number == 0 || !realism.enabled || realism.per_robot_hour == 0) return;
  failures.count += number << 32;  // no stream comes to that many draws
  RandomStream random(world.settings.options.seed, Matter::kFailure, 0, failures.count++);
  failures.exposure = random.exponential(kHour / realism.per_robot_hour);
}

bool mayFail(const Realism& realism, const FailureState& failures) {
  return realism.failures.enabled || !failures.defects.empty();
}

void restoreDefects(FleetState& f, const Realism& realism, const FailureState& failures) {
  f.failures.assign(f.size(), 0);
  for (const Defect& defect : failures.defects) {
    apply(f, realism, f.find(defect.kiva_id), defect.failure);
  }
}

}  // namespace kiva
