// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/communication/command_link.h"
#include "core/control/route.h"
#include "core/control/shadows.h"
#include "core/control/steering.h"
#include "core/disturbances/failures.h"
#include "core/disturbances/falling_items.h"
#include "core/people/protective_fields.h"
#include "core/people/walking.h"
#include "core/state/world_state.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {
namespace {

/// Calls act(robot) for the robot of that id. Throws std::invalid_argument, which names the robot,
/// for a refusal.
template <typename Act>
void withRobot(const WorldState& world, int kiva_id, Act act) {
  const std::string name = "kiva" + std::to_string(kiva_id);
  const int robot = world.fleet.find(kiva_id);
  if (robot < 0) throw std::invalid_argument("there is no robot " + name);
  try {
    act(robot);
  } catch (const Refusal& refusal) {
    throw std::invalid_argument(name + ": " + refusal.what());
  }
}

}  // namespace

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
  const auto isTooSlow = [](double value) { return !(value > 0); };
  const auto slow = std::find_if(path.max_speed.begin(), path.max_speed.end(), isTooSlow);
  if (slow != path.max_speed.end()) {
    path.fault = format("max_speed %g: a speed above 0 was expected", *slow);
    path.max_speed.clear();
  }
  Command command;
  command.kind = Command::Kind::kFollow;
  command.kiva_id = path.kiva_id;
  send(state_->command_link, state_->inbox, state_->view, {command, std::move(path)});
}

void World::beginSteering(int kiva_id) {
  withRobot(*state_, kiva_id, [&](int robot) {
    if (isShadow(kiva_id)) throw Refusal("it is the shadow of a robot elsewhere");
    kiva::beginSteering(state_->view, robot);
  });
}

void World::steer(int kiva_id, double speed, double turn_rate) {
  withRobot(*state_, kiva_id, [&](int robot) {
    kiva::steer(state_->view, robot, {speed, turn_rate});
  });
}

void World::endSteering(int kiva_id) {
  withRobot(*state_, kiva_id, [&](int robot) { kiva::endSteering(state_->view, robot); });
}

std::vector<int> World::steeredRobots() const {
  std::vector<int> ids;
  for (const Steering& steering : state_->fleet.steerings) ids.push_back(steering.kiva_id);
  return ids;
}

bool World::isSteered(int robot) const { return state_->fleet.tasks[robot].isSteered(); }

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

std::optional<PlanarTwist> World::shadowTwist(int robot) const {
  const auto& twists = state_->shadows.twists;
  const auto at = twists.find(state_->fleet.robots[robot].id);
  if (at == twists.end()) return std::nullopt;
  return at->second;
}

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
