// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/communication/command_link.h"
#include "core/control/shadows.h"
#include "core/disturbances/failures.h"
#include "core/disturbances/falling_items.h"
#include "core/people/protective_fields.h"
#include "core/people/walking.h"
#include "core/state/world_state.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {

void World::post(const Command& command) {
  if (command.kind == Command::Kind::kFollow) {
    throw std::invalid_argument("a path is posted as a FollowPath");
  }
  send(state_->command_link, state_->inbox, state_->view, {command, {}});
}

void World::post(FollowPath path) {
  const auto isNone = [](double value) { return !std::isfinite(value); };
  for (std::vector<double>* column : {&path.x, &path.y}) {
    if (std::none_of(column->begin(), column->end(), isNone)) continue;
    path.fault = "a coordinate is not a finite number";
    column->clear();
  }
  Command command;
  command.kind = Command::Kind::kFollow;
  command.kiva_id = path.kiva_id;
  send(state_->command_link, state_->inbox, state_->view, {command, std::move(path)});
}

void World::fail(int kiva_id, Failure failure, double repair_after) {
  injectFailure(state_->view, state_->failures, kiva_id, failure, repair_after);
}

void World::repair(int kiva_id) { kiva::repair(state_->view, state_->failures, kiva_id); }

std::optional<RobotReport> World::lastHeard(int robot) const {
  return kiva::lastHeard(state_->view, state_->failures, robot);
}

void World::keepMode(int kiva_id, int mode) {
  const int robot = state_->fleet.find(kiva_id);
  if (robot < 0) throw std::invalid_argument("there is no kiva" + std::to_string(kiva_id));
  if (mode < 0 || mode > kMostMode) {
    throw std::invalid_argument("mode is " + std::to_string(mode) + "; 0 to " +
                                std::to_string(kMostMode) + " was expected");
  }
  state_->fleet.mode[robot] = static_cast<std::uint8_t>(mode);
}

void World::shadow(int kiva_id, const ShadowReport& report) {
  moveShadow(state_->view, state_->shadows, kiva_id, report);
}

bool World::isShadow(int kiva_id) const { return state_->shadows.has(kiva_id); }

void World::walk(const std::string& person, const Walk& walk) {
  kiva::walk(state_->view, state_->people, person, walk);
}

std::vector<Person> World::people() const { return listPeople(state_->view); }

void World::setLightCurtain(const LightCurtain& curtain) {
  kiva::setLightCurtain(state_->people, curtain);
}

bool World::removeLightCurtain(const std::string& name) {
  return kiva::removeLightCurtain(state_->people, name);
}

const std::vector<LightCurtain>& World::lightCurtains() const { return state_->people.curtains; }
std::vector<FallenItem> World::fallenItems() const { return listFallenItems(state_->view); }
void World::pickUp(const std::string& item) { kiva::pickUp(state_->view, item); }

}  // namespace kiva
