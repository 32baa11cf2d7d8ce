// SPDX-License-Identifier: Apache-2.0
#include "core/contact/activation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/contact/upright.h"
#include "core/motion/driving/clearance.h"
#include "core/motion/dynamics.h"
#include "core/motion/wheels/traction.h"
#include "core/parallel/avx2_clone.h"
#include "core/parallel/workers.h"
#include "core/state/places/footprints.h"

namespace kiva {
namespace {

constexpr double kReach = 0.3;    // [m] around a robot that are searched
constexpr double kLinger = 0.05;  // [s] in Bullet after nothing was near any more
// Slow models in Bullet search seldom: in that time they move by less than kNear.
constexpr double kSlow = 0.2, kSeldom = 0.008;  // [m/s, s]
constexpr int kLooksTogether = 32;  // on one thread: fewer do not justify waking another

/// A load enters with the robot that carries it.
void activateWhole(ContactView& world, int slot) {
  Model& model = *world.models[slot];
  if (!model.owner->isActivatedWhenNear()) return;
  const int robot = model.owner->robot(world, model);
  activate(world, robot < 0 ? model : world.models.of(world.fleet.robots[robot]));
}

/// Puts models into Bullet in an order that does not depend on the index of obstacles.
void activateAll(ContactView& world, std::vector<int> slots) {
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  for (int slot : slots) activateWhole(world, slot);
}

/// Puts the robot, which has no clearance, and all models that it could touch into Bullet.
void activateClose(ContactView& world, int robot) {
  FleetState& f = world.fleet;
  std::vector<int> close;
  const auto& own = world.obstacles.footprints(robot);
  const double least = findClose(world, own, pointSpeed(f, robot), kReach, &close);
  if (!close.empty()) activate(world, world.models.of(world.fleet.robots[robot]));
  activateAll(world, std::move(close));
  // Twice the distance: the other model may approach as well, and both may speed up.
  const double way = 2 * (world.fleet.fastest + kCornerSpeed) * world.clock.dt;
  const double free_steps = std::floor((least - kNear) / way - 1);
  const double seldom =
      f.activated[robot] ? static_cast<double>(world.clock.stepsIn(kSeldom)) : 0.0;
  f.clear_until[robot] =
      static_cast<double>(world.clock.total_steps) + std::max(seldom, free_steps);
}

bool isMoving(const FleetState& fleet, int robot) {
  return fleet.tasks[robot].phase != Phase::kIdle || !atRest(fleet, robot);
}

bool looksAround(const Scene& world, int robot) {
  const FleetState& f = world.fleet;
  const bool is_hasty = f.activated[robot] && pointSpeed(f, robot) > kSlow;
  const bool is_known = f.clear_until[robot] > static_cast<double>(world.clock.total_steps);
  return (is_hasty || !is_known) && isMoving(world.fleet, robot);
}

/// Returns for how long the way of each searching robot is free [s], with all poses as they are; 0
/// for others. Entries are in the order of the robots that are stepped singly.
std::vector<double> clearTimes(const Scene& world) {
  const std::vector<int>& robots = world.schedule.stepped_singly;
  std::vector<double> times(robots.size(), 0);
  std::vector<int> asking;
  for (std::size_t k = 0; k < robots.size(); ++k) {
    const bool asks = looksAround(world, robots[k]) && !world.fleet.activated[robots[k]];
    if (asks) asking.push_back(static_cast<int>(k));
  }
  world.schedule.workers->share(static_cast<int>(asking.size()), kLooksTogether,
                                [&](int begin, int end) {
                                  for (int a = begin; a < end; ++a)
                                    times[asking[a]] = clearTime(world, robots[asking[a]], true);
                                });
  return times;
}

/// Searches robot by robot, since a model that enters Bullet changes the next result.
void lookAround(ContactView& world) {
  const FleetState& f = world.fleet;
  const auto asks = [&](int robot) { return looksAround(world, robot); };
  const std::vector<int>& all = world.schedule.stepped_singly;
  if (std::none_of(all.begin(), all.end(), asks)) return;
  const std::vector<double> times = clearTimes(world);
  const std::size_t before = world.models.activated.size();
  for (std::size_t k = 0; k < times.size(); ++k) {
    const int i = all[k];
    if (!asks(i)) continue;
    const bool is_known = world.models.activated.size() == before;
    const auto time = [&] { return is_known ? times[k] : clearTime(world, i, true); };
    if (f.activated[i] || !noteClearance(world, world.obstacles, i, time()))
      activateClose(world, i);
  }
}

/// Returns whether all points of a sliding storage unit are slow.
bool isSlow(const Model& model) {
  constexpr double kFarthest = 1;  // largest distance from its centre of mass [m]
  const btRigidBody& body = *model.bodies.links.front().body;
  return body.getLinearVelocity().length() + kFarthest * body.getAngularVelocity().length() < kSlow;
}

/// Puts models into Bullet that a freely moving body could hit.
void activateNearBody(ContactView& world, Model& model) {
  if (!isAwake(model)) return;
  const bool is_due = (world.clock.total_steps + model.slot) % world.clock.stepsIn(kSeldom) == 0;
  if (model.upright && !is_due && isSlow(model)) return;
  double fastest = 0;
  for (const LinkBody& link : model.bodies.links) {
    fastest = std::max(fastest, link.body->getLinearVelocity().length());
  }
  const double near = kNear + 4 * fastest * world.clock.dt;
  std::vector<Footprint> all;
  for (const CollisionGeometry& geometry : model.geometries) {
    all.push_back(world.obstacles[geometry.handle]);
    all.back().z_min -= near;  // a body may fall or be thrown on something
    all.back().z_max += near;
  }
  std::vector<int> close;
  findClose(world, all, 4 * fastest, near, &close);
  activateAll(world, close);
  if (model.owner->isActivatedWhenNear()) return;
  for (int slot : close) {
    Model& other = *world.models[slot];
    other.tips = other.in_physics && other.owner->isActivatedWhenNear();  // the body may fall on it
  }
}

void release(ContactView& world) {
  for (std::size_t k = 0; k < world.models.activated.size();) {
    Model& model = *world.models[world.models.activated[k]];
    if (model.owner->mayLeaveBullet(world, model, model.active_until < world.clock.total_steps)) {
      deactivate(world, model);  // removes entry k
    } else {
      ++k;
    }
  }
}

/// Most blocks of a large fleet have no such robot, and cost little.
KIVA_AVX2_CLONE void findSteppedSingly(const std::uint8_t* awake, const std::int64_t* cruising,
                                       int count, std::vector<int>* robots) {
  constexpr int kBlock = 16;
  for (int begin = 0; begin < count; begin += kBlock) {
    const int end = std::min(begin + kBlock, count);
    std::int64_t any = 0;
    for (int i = begin; i < end; ++i) any |= awake[i] & ~cruising[i];
    if (any == 0) continue;
    for (int i = begin; i < end; ++i) {
      if (awake[i] && cruising[i] == 0) robots->push_back(i);
    }
  }
}

void findSteppedSingly(const Scene& world, StepSchedule& schedule) {
  const FleetState& f = world.fleet;
  std::vector<int>* robots = &schedule.stepped_singly;
  robots->clear();
  findSteppedSingly(f.awake.data(), f.cruising.data(), f.size(), robots);
}

}  // namespace

void activate(ContactView& world, Model& model) {
  model.active_until = world.clock.total_steps + world.clock.stepsIn(kLinger);
  if (model.in_physics) return;
  model.upright = model.owner->mayBeUpright(world, model);
  model.bodies = model.owner->build(world, model);
  world.physics.insert(model.bodies);
  model.in_physics = true;
  world.models.activated.push_back(model.slot);
  model.owner->activated(world, model);
}

void deactivate(ContactView& world, Model& model) {
  model.owner->deactivated(world, model);
  world.physics.remove(model.bodies);
  model.bodies = ModelBodies();
  model.in_physics = model.upright = model.tips = false;
  model.rocking = Vector3::Zero;
  auto& slots = world.models.activated;
  slots.erase(std::remove(slots.begin(), slots.end(), model.slot), slots.end());
  moved(world, model);
}

void rebuildBody(ContactView& world, Model& model) {
  if (!model.in_physics) return;
  deactivate(world, model);
  activate(world, model);
}

void letFall(ContactView& world, Model& model) {
  activate(world, model);
  if (model.upright) letTip(world, model);
  for (LinkBody& link : model.bodies.links) link.body->forceActivationState(ACTIVE_TAG);
  model.disturbed = true;
}

void updateActivation(ContactView& world) {
  const FleetState& f = world.fleet;
  if (world.settings.options.always_in_bullet) {
    for (int i = 0; i < f.size(); ++i) activate(world, world.models.of(world.fleet.robots[i]));
  }
  findSteppedSingly(world, world.schedule);
  const std::size_t before = world.models.activated.size();
  lookAround(world);
  for (int slot : world.models.bodies) activateNearBody(world, *world.models[slot]);
  const std::vector<int> activated = world.models.activated;  // it grows meanwhile
  for (int slot : activated) {
    if (world.models[slot]->disturbed) activateNearBody(world, *world.models[slot]);
  }
  updateUprightness(world);
  const bool has_more = world.models.activated.size() > before;
  release(world);
  if (has_more) findSteppedSingly(world, world.schedule);  // activated robots have woken
}

}  // namespace kiva
