// SPDX-License-Identifier: Apache-2.0
#include "core/state/robots/fleet_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kiva {
namespace {

constexpr double kCaughtUp = 1e-6;       // [m, rad] of lag that counts as none
constexpr double kCommandStands = 1e-9;  // [m/s, rad/s]

/// Calls visit(array) for every array that is not part of the public fleet.
template <typename Visit>
void forEachArray(FleetState& f, Visit visit) {
  for (int wheel = 0; wheel < 2; ++wheel) {
    visit(f.wheel_target[wheel]);
    visit(f.per_wheel[wheel]);
  }
  for (auto* array :
       {&f.reference, &f.reference_speed, &f.command_speed, &f.reference_end, &f.deceleration,
        &f.per_x, &f.per_y, &f.per_yaw, &f.top_speed, &f.acceleration, &f.clear_until, &f.attend_at,
        &f.count_at, &f.wedged_until}) {
    visit(*array);
  }
  visit(f.cruising);
  visit(f.awake);
  visit(f.activated);
  visit(f.tasks);
  visit(f.battery);
  visit(f.heard);
  visit(f.sway);
}

}  // namespace

int FleetState::add(Robot robot, double x, double y, double yaw) {
  forEachArray(*this, [](auto& array) { array.emplace_back(); });
  if (localises) localisation.emplace_back();
  return Fleet::add(std::move(robot), x, y, yaw);
}

void FleetState::remove(int i) {
  forEachArray(*this, [i](auto& array) {
    array[i] = std::move(array.back());
    array.pop_back();
  });
  const int id = robots[i].id;
  steerings.erase(std::remove_if(steerings.begin(), steerings.end(),
                                 [id](const Steering& s) { return s.kiva_id == id; }),
                  steerings.end());
  if (localises) {
    localisation[i] = localisation.back();
    localisation.pop_back();
  }
  Fleet::remove(i);
}

void FleetState::applyRealism(const Realism& realism, double dt) {
  localises = realism.localisation.enabled;
  const double time = realism.actuation.enabled ? realism.actuation.motor_lag : 0;
  lag = {};
  if (time == 0) return;
  lag.share = 1 - std::exp(-dt / time);
  lag.behind = (1 / lag.share - 1) * dt;
}

const Steering& FleetState::steering(int i) const {
  const int id = robots[i].id;
  return *std::find_if(steerings.begin(), steerings.end(),
                       [id](const Steering& s) { return s.kiva_id == id; });
}

Steering& FleetState::steering(int i) {
  return const_cast<Steering&>(std::as_const(*this).steering(i));
}

void FleetState::follow(int i, const Profile& command) {
  if (lag.isNone()) return setProfile(i, command);
  const double speed = reference_speed[i] + lag.share * (command.speed - reference_speed[i]);
  const bool has_ended =
      std::abs(command.speed) < kCommandStands && std::abs(lag.behind * speed) < kCaughtUp;
  reference_speed[i] = has_ended ? 0 : speed;
  command_speed[i] = has_ended ? 0 : command.speed;
  reference[i] = command.position - lag.behind * reference_speed[i];
}

bool isHeld(const FleetState& f, int i) {
  if (f.stopped[i] || f.curtained[i]) return true;
  if (f.failures[i] == 0 && f.allowed_speed[i] > 0) return false;
  const bool moves = f.tasks[i].movesOnFloor() || f.tasks[i].isSteered();
  if (moves && f.allowed_speed[i] == 0) return true;
  const int holds = moves ? bitOf(Failure::kMotor) | bitOf(Failure::kLaser) : bitOf(Failure::kLift);
  return (f.failures[i] & (holds | kEmptyBattery)) != 0;
}

void moved(FleetState& f, int i) {
  f.awake[i] = 1;
  f.clear_until[i] = 0;
  if (f.cruising[i] == 0) return;
  f.cruising[i] = 0;
  if (f.localises) {
    f.localisation[i].settle(f.reference[i], f.wheel_angle[0][i], f.wheel_angle[1][i]);
  }
  for (int wheel = 0; wheel < 2; ++wheel) f.wheel_target[wheel][i] = f.wheel_speed[wheel][i];
}

}  // namespace kiva
