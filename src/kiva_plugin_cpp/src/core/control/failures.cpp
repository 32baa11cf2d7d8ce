// SPDX-License-Identifier: Apache-2.0
#include "core/control/failures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/control/interruptions.h"
#include "core/state/tasks.h"

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

int findRobot(const WorldState& world, int kiva_id) {
  const int robot = world.fleet.find(kiva_id);
  if (robot >= 0) return robot;
  throw std::invalid_argument("there is no robot kiva" + std::to_string(kiva_id));
}

RobotReport reportOf(const WorldState& world, int robot) {
  const Fleet& f = world.fleet;
  const int unit = f.unit[robot];
  return {f.x[robot],        f.y[robot],
          f.yaw[robot],      f.vx[robot],
          f.vy[robot],       f.yaw_rate[robot],
          f.status[robot],   f.state[robot],
          unit < 0 ? 0 : world.units[unit].id,
          f.path_id[robot],  f.reached[robot],
          f.left[robot],     f.last_end[robot]};
}

void apply(FleetState& fleet, int robot, Failure failure) {
  fleet.failures[robot] |= bitOf(failure);
  if (failure == Failure::kWheelSlip) fleet.robots[robot].grip = kSlippingGrip;
}

void tell(WorldState& world, Event::Kind kind, int robot, const std::string& text) {
  world.report(kind, world.fleet.robots[robot].name, "", text);
}

std::string within(double seconds) {
  if (std::isinf(seconds)) return "";
  char text[64];
  std::snprintf(text, sizeof text, "; repaired in %.0f s", seconds);
  return text;
}

/// Its motion goes on with what it can do now. Who stands has nothing to do anew.
void adapt(WorldState& world, int robot) {
  FleetState& f = world.fleet;
  const Phase phase = f.tasks[robot].phase;
  const bool moves = phase == Phase::kDriving || phase == Phase::kTurning;
  if (moves && !isHeld(f, robot)) planAnew(world, robot);
  if (f.awake[robot]) moved(f, robot);
}

void mend(WorldState& world, const Defect& defect) {
  FleetState& f = world.fleet;
  const int robot = f.find(defect.kiva_id);
  const bool was_held = isHeld(f, robot);
  f.failures[robot] &= static_cast<std::uint8_t>(~bitOf(defect.failure));
  if (defect.failure == Failure::kWheelSlip) {
    f.robots[robot].grip = 1;
    adapt(world, robot);
  }
  if (was_held && !isHeld(f, robot)) planAnew(world, robot);
  tell(world, Event::Kind::kRepaired, robot, std::string("repaired: ") + nameOf(defect.failure));
  if (defect.failure != Failure::kRadio) return;
  // What nobody heard of meanwhile.
  f.tasks[robot].reported_shelf = -1;
  world.setStatus(robot, f.status[robot], f.state[robot]);
}

/// Uniform in (0, 1): number `drawn` of the world's seed (SplitMix64, Steele et al. 2014).
double draw(WorldState& world) {
  std::uint64_t z = (world.options.seed ^ 0x6661696c75726573ULL) +
                    0x9e3779b97f4a7c15ULL * ++world.failures.drawn;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  z ^= z >> 31;
  return (static_cast<double>(z >> 11) + 0.5) * 0x1p-53;
}

double drawExponential(WorldState& world, double mean) { return -mean * std::log(draw(world)); }

Failure drawFailure(WorldState& world) {
  const auto& share = world.failures.model.share;
  double left = draw(world) * std::accumulate(share.begin(), share.end(), 0.0);
  int kind = 0;
  while (kind + 1 < kFailureKinds && left >= share[kind]) left -= share[kind++];
  while (share[kind] == 0) --kind;  // that rounding came to
  return static_cast<Failure>(kind + static_cast<int>(Failure::kMotor));
}

void breakSomething(WorldState& world) {
  const int robots = world.fleet.size();
  const int robot = std::min(robots - 1, static_cast<int>(draw(world) * robots));
  const Failure failure = drawFailure(world);
  const double repair = std::max(world.dt, drawExponential(world, world.failures.model.repair));
  breakDown(world, world.fleet.robots[robot].id, failure, repair);
}

void repairWhoIsDue(WorldState& world) {
  auto& defects = world.failures.defects;
  for (Defect& defect : defects) defect.left -= world.dt;
  const auto is_due = [](const Defect& defect) { return defect.left <= 0; };
  for (auto at = defects.begin(); (at = std::find_if(at, defects.end(), is_due)) != defects.end();) {
    const Defect defect = *at;
    at = defects.erase(at);
    mend(world, defect);
  }
}

}  // namespace

void breakDown(WorldState& world, int kiva_id, Failure failure, double repair_after) {
  const int robot = findRobot(world, kiva_id);
  if (!(repair_after >= 0 && std::isfinite(repair_after))) {
    throw std::invalid_argument("repair_after must be finite and at least 0 s");
  }
  if (nameOf(failure)[0] == 0) throw std::invalid_argument("there is no such failure");
  const double left = repair_after > 0 ? repair_after : HUGE_VAL;
  FleetState& f = world.fleet;
  for (Defect& defect : world.failures.defects) {
    if (defect.kiva_id != kiva_id || defect.failure != failure) continue;
    defect.left = left;
    return;
  }
  tell(world, Event::Kind::kFailed, robot, nameOf(failure) + within(left));
  world.failures.defects.push_back({kiva_id, failure, left, reportOf(world, robot)});
  apply(f, robot, failure);
  adapt(world, robot);
}

void repair(WorldState& world, int kiva_id) {
  findRobot(world, kiva_id);
  auto& defects = world.failures.defects;
  const auto is_its = [kiva_id](const Defect& defect) { return defect.kiva_id == kiva_id; };
  for (auto at = defects.begin(); (at = std::find_if(at, defects.end(), is_its)) != defects.end();) {
    const Defect defect = *at;
    at = defects.erase(at);
    mend(world, defect);
  }
}

std::optional<RobotReport> lastHeard(const WorldState& world, int robot) {
  if ((world.fleet.failures[robot] & bitOf(Failure::kRadio)) == 0) return std::nullopt;
  const int id = world.fleet.robots[robot].id;
  for (const Defect& defect : world.failures.defects) {
    if (defect.kiva_id == id && defect.failure == Failure::kRadio) return defect.last;
  }
  return std::nullopt;
}

void setFailureModel(WorldState& world, const FailureModel& model) {
  const auto is_share = [](double share) { return share >= 0 && std::isfinite(share); };
  const bool has_shares = std::all_of(model.share.begin(), model.share.end(), is_share) &&
                          std::accumulate(model.share.begin(), model.share.end(), 0.0) > 0;
  if (!(model.rate >= 0 && std::isfinite(model.rate))) {
    throw std::invalid_argument("the rate of failures must be finite and at least 0 an hour");
  }
  if (!(model.repair > 0 && std::isfinite(model.repair))) {
    throw std::invalid_argument("the time of a repair must be finite and above 0 s");
  }
  if (!has_shares) {
    throw std::invalid_argument("the kinds' shares must be at least 0, and one of them above 0");
  }
  world.failures.model = model;
  world.failures.exposure = model.rate > 0 ? drawExponential(world, kHour / model.rate) : 0;
}

void wearOut(WorldState& world) {
  FailureState& failures = world.failures;
  if (!failures.defects.empty()) repairWhoIsDue(world);
  if (failures.model.rate == 0 || world.fleet.size() == 0) return;
  failures.exposure -= world.fleet.size() * world.dt;
  while (failures.exposure <= 0) {
    breakSomething(world);
    failures.exposure += drawExponential(world, kHour / failures.model.rate);
  }
  failures.exposure = std::max(0.0, failures.exposure);
}

void beginFailures(WorldState& world) {
  const FailureModel model = world.failures.model;
  world.failures = {};
  setFailureModel(world, model);
}

bool mayFail(const WorldState& world) {
  return world.failures.model.rate > 0 || !world.failures.defects.empty();
}

void markDefects(WorldState& world) {
  FleetState& f = world.fleet;
  f.failures.assign(f.size(), 0);
  for (const Defect& defect : world.failures.defects) {
    apply(f, f.find(defect.kiva_id), defect.failure);
  }
}

}  // namespace kiva
