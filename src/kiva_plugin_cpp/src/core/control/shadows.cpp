// SPDX-License-Identifier: Apache-2.0
#include "core/control/shadows.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "core/models/load.h"
#include "core/models/models.h"
#include "core/state/places/poses.h"
#include "core/state/progress/tasks.h"

namespace kiva {
namespace {

[[noreturn]] void fail(const std::string& text) { throw std::invalid_argument(text); }

int findRobot(const Scene& world, int kiva_id) {
  const int robot = world.fleet.find(kiva_id);
  if (robot < 0) fail("there is no robot kiva" + std::to_string(kiva_id));
  return robot;
}

/// Returns the index of the unit in the report, -1 if it has none.
int findLoad(const Scene& world, int robot, int unit_id) {
  if (unit_id == 0) return -1;
  const std::string name = "storage_unit" + std::to_string(unit_id);
  const auto at = world.storage.unit_of_id.find(unit_id);
  if (at == world.storage.unit_of_id.end()) fail("there is no " + name);
  const int carrier = world.storage.units[at->second].carrier;
  if (carrier >= 0 && carrier != robot) {
    fail(name + " is carried by " + world.fleet.robots[carrier].name);
  }
  return at->second;
}

/// Throws for a report that no robot could make: a shadow's report is published as a robot's state.
/// The pose is checked where the model is placed.
void checkReport(const ShadowReport& shadow) {
  const RobotReport& report = shadow.report;
  if (!(std::isfinite(report.x) && std::isfinite(report.y) && std::isfinite(report.yaw))) {
    fail("the pose of a shadow must be finite");
  }
  if (!(std::isfinite(report.vx) && std::isfinite(report.vy) && std::isfinite(report.yaw_rate))) {
    fail("the velocity of a shadow must be finite");
  }
  if (!(shadow.charge >= 0 && shadow.charge <= 1)) fail("the charge of a shadow must be 0 to 1");
  const auto end = static_cast<EventKind>(report.last_end);
  if (report.last_end != 0 && end != EventKind::kDone && end != EventKind::kBlocked) {
    fail("the last end of a shadow must be 0, DONE or BLOCKED");
  }
}

/// Puts the unit onto the robot, wherever it stood, since the robot elsewhere has it.
void load(ModelView& world, int robot, int unit) {
  Model& model = *world.models[world.storage.units[unit].model];
  const PlanarPose at = {world.fleet.x[robot], world.fleet.y[robot], world.fleet.yaw[robot]};
  const double yaw = unitPose(world, unit).Rot().Yaw();
  placeModel(world, model, {Pose(at.x, at.y, world.floor.extent.z, 0, 0, yaw), {}});
  takeUp(world, robot, unit);
  world.fleet.tower[robot] = world.fleet.robots[robot].lift.height;
}

void exchangeLoad(ModelView& world, int robot, int unit) {
  if (world.fleet.unit[robot] == unit) return;
  if (world.fleet.unit[robot] >= 0) {
    putDown(world, robot);
    world.fleet.tower[robot] = 0;
  }
  if (unit >= 0) load(world, robot, unit);
}

void takeReport(TaskView& world, int robot, const ShadowReport& shadow) {
  FleetState& f = world.fleet;
  setStatus(world, robot, shadow.report.status, shadow.report.state);
  f.path_id[robot] = shadow.report.path_id;
  f.reached[robot] = shadow.report.reached;
  f.left[robot] = shadow.report.left;
  f.last_end[robot] = shadow.report.last_end;
  f.failures[robot] = shadow.failures;
  f.charge[robot] = shadow.charge;
}

/// Moves the robot to the reported pose, its wheels at rest.
void place(ModelView& world, int robot, const RobotReport& report) {
  const Pose at(report.x, report.y, world.floor.extent.z, 0, 0, report.yaw);
  placeModel(world, world.models.of(world.fleet.robots[robot]), {at, {}});
  for (auto& speeds : world.fleet.wheel_speed) speeds[robot] = 0;
}

bool isThere(const Fleet& f, int robot, const RobotReport& report) {
  return f.x[robot] == report.x && f.y[robot] == report.y && f.yaw[robot] == report.yaw;
}

}  // namespace

void moveShadow(ModelView& world, Shadows& shadows, int kiva_id, const ShadowReport& shadow) {
  checkReport(shadow);
  const int robot = findRobot(world, kiva_id);
  if (world.fleet.tasks[robot].isSteered()) {
    fail(world.fleet.robots[robot].name + " is driven by velocities, and can't be a shadow");
  }
  const int unit = findLoad(world, robot, shadow.report.shelf_id);
  if (!shadows.has(kiva_id) || !isThere(world.fleet, robot, shadow.report)) {
    place(world, robot, shadow.report);
  }
  const RobotReport& report = shadow.report;
  shadows.twists[kiva_id] = {report.vx, report.vy, report.yaw_rate};
  exchangeLoad(world, robot, unit);
  takeReport(world, robot, shadow);
}

void endShadow(Shadows& shadows, int kiva_id) { shadows.twists.erase(kiva_id); }

}  // namespace kiva
