// SPDX-License-Identifier: Apache-2.0
#include "core/state/world_state.h"

#include "core/state/workers.h"

namespace kiva {
namespace {

int shelfId(const WorldState& world, int robot) {
  const int unit = world.fleet.unit[robot];
  return unit < 0 ? 0 : world.units[unit].id;
}

}  // namespace

WorldState::WorldState(const WorldDescription& description, const WorldOptions& world_options)
    : name(description.name),
      gravity(description.gravity),
      options(world_options),
      realism(world_options.realism.value_or(Realism())),
      dt(description.step_size),
      physics(description.gravity),
      workers(std::make_shared<Workers>(options.threads)) {
  applyRealism();
}

WorldState::~WorldState() {
  for (auto& model : models) {
    if (model && model->in_physics) physics.remove(model->bodies);
  }
}

void WorldState::applyRealism() {
  fleet.localises = realism.localisation.enabled;
  const double time = realism.actuation.enabled ? realism.actuation.motor_lag : 0;
  fleet.lag = {};
  if (time == 0) return;
  fleet.lag.share = 1 - std::exp(-dt / time);
  fleet.lag.behind = (1 / fleet.lag.share - 1) * dt;
}

void WorldState::report(Event::Kind kind, const std::string& model, const std::string& other,
                        const std::string& text, const Impact& impact) {
  events.push_back({time(), kind, model, other, text, 0, impact});
}

void WorldState::reportCommand(Event::Kind kind, int robot, const std::string& other,
                               const std::string& text) {
  events.push_back(
      {time(), kind, fleet.robots[robot].name, other, text, fleet.tasks[robot].command, {}});
}

void WorldState::warn(const std::string& subject, const std::string& text) {
  if (warned.insert(subject).second) warnings.push_back(text);
}

void WorldState::setStatus(int robot, Status status, State state) {
  Task& task = fleet.tasks[robot];
  const int shelf = shelfId(*this, robot);
  const bool is_silent = (fleet.failures[robot] & bitOf(Failure::kRadio)) != 0;
  if (fleet.status[robot] == status && fleet.state[robot] == state &&
      task.reported_shelf == shelf) {
    return;
  }
  fleet.status[robot] = status;
  fleet.state[robot] = state;
  task.reported_shelf = shelf;
  if (is_silent) return;
  if (realism.radio.delaysReports()) {
    to_report.push_back(fleet.robots[robot].id);
    return;
  }
  status_changes.push_back({time(), fleet.robots[robot].id, status, state, shelf, fleet.x[robot],
                            fleet.y[robot], fleet.yaw[robot]});
}

}  // namespace kiva
