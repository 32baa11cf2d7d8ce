// SPDX-License-Identifier: Apache-2.0
#include "core/models/storage_units.h"

#include <algorithm>
#include <cmath>

#include "core/contact/activation.h"
#include "core/contact/upright.h"
#include "core/models/load.h"
#include "core/models/ordinary_models.h"
#include "core/state/places/floors.h"
#include "core/state/places/footprints.h"
#include "core/state/places/poses.h"
#include "core/state/places/unit_geometry.h"

namespace kiva {
namespace {

// Limits within which a unit stands on its legs again: speed, tilt and height above the floor.
constexpr double kStill = 1e-3;     // [m/s]
constexpr double kTilt = 1 - 5e-5;  // cosine
constexpr double kAbove = 0.002;    // [m]
constexpr double kResting = 0.05;   // [s] at rest in Bullet

bool standsStill(const Scene& world, const Model& model) {
  const btRigidBody& body = *model.bodies.links.front().body;
  const double up = body.getWorldTransform().getBasis().getColumn(2).z();
  return up > kTilt && body.getLinearVelocity().length() < kStill &&
         body.getAngularVelocity().length() < kStill &&
         unitPose(world, model.index).Z() - world.floor.extent.z < kAbove;
}

/// Replaces the index `from` of a unit by `to` wherever it is stored; -1 = the unit is gone.
void reindexUnit(ModelTable& models, FleetState& fleet, Storage& storage, int from, int to) {
  for (const int item : storage.items_on[from]) storage.items[item].unit = to;
  if (to >= 0) storage.items_on[to] = storage.items_on[from];
  storage.items_on[from].clear();
  for (Task& task : fleet.tasks) {
    for (MotionSegment& segment : task.segments) {
      if (segment.unit == from) segment.unit = to;
    }
  }
  if (to < 0) return;
  const StorageUnit& unit = storage.units[to];
  storage.unit_of_id[unit.id] = to;
  models[unit.model]->index = to;
  if (unit.carrier >= 0) fleet.unit[unit.carrier] = to;
}

/// Takes the unit off its robot, and out of Bullet.
void takeAway(ContactView& world, Model& model) {
  const int carrier = world.storage.units[model.index].carrier;
  if (carrier >= 0) putDown(world, carrier);
  if (model.in_physics) deactivate(world, model);
}

}  // namespace

void StorageUnits::add(ModelView& world, Model& model) const {
  StorageUnit unit;
  unit.name = model.name;
  unit.id = numberIn(model.name, "storage_unit");
  unit.model = model.slot;
  unit.mass = massOf(*model.description);
  raiseToFloor(world, &unit, &model);
  model.index = static_cast<int>(world.storage.units.size());
  world.storage.units.push_back(unit);
  world.storage.items_on.emplace_back();
  world.storage.unit_of_id[unit.id] = model.index;
  addCollisionGeometry(world.floor, model);
  if (!standsUpright(world, model.index)) letFall(world, model);
}

void StorageUnits::remove(ModelView& world, Model& model) const {
  if (model.index < 0) return;  // it never joined the units
  const int index = model.index, last = static_cast<int>(world.storage.units.size()) - 1;
  const StorageUnit& unit = world.storage.units[index];
  if (unit.carrier >= 0) unload(world, unit.carrier);
  world.storage.unit_of_id.erase(unit.id);
  reindexUnit(world.models, world.fleet, world.storage, index, -1);
  if (index != last) {
    world.storage.units[index] = std::move(world.storage.units[last]);
    reindexUnit(world.models, world.fleet, world.storage, last, index);
  }
  world.storage.units.pop_back();
  world.storage.items_on.pop_back();
  world.storage.noteMove();
}

std::vector<int> StorageUnits::passengers(const Scene& world, const Model& model) const {
  std::vector<int> slots;
  for (const int item : world.storage.items_on[model.index]) {
    slots.push_back(world.storage.items[item].model);
  }
  return slots;
}

void StorageUnits::place(ModelView& world, Model& model, const EntityState& state) const {
  takeAway(world, model);
  model.pose = state.pose;
  letFall(world, model);  // a unit placed by hand may float: Bullet decides
  moveBodies(model, state);
}

void StorageUnits::reset(ModelView& world, Model& model) const {
  takeAway(world, model);
  model.pose = model.spawn_pose;
  if (!standsUpright(world, model.index)) letFall(world, model);
}

EntityState StorageUnits::state(const Scene& world, const Model& model) const {
  if (followsBodies(model)) return canonicalState(model);
  const int carrier = world.storage.units[model.index].carrier;
  const Pose pose = unitPose(world, model.index);
  return carrier < 0 ? EntityState{pose, {}} : carriedState(robotState(world, carrier), pose);
}

Pose StorageUnits::linkPose(const Scene& world, const Model& model, int link) const {
  if (followsBodies(model)) return fromBullet(model.bodies.links[link].linkPose());
  return unitPose(world, model.index) * model.description->links[link].pose_in_model;
}

void StorageUnits::reweigh(ContactView& world, Model& model, double added) const {
  addMass(world, model.index, added);
  if (!model.in_physics) return;
  const EntityState state = bodyState(model.bodies.links.front());
  deactivate(world, model);
  letFall(world, model);
  setBodyState(model.bodies.links.front(), state);
}

bool StorageUnits::push(ContactView& world, Model& model, int link, const Vector3& at,
                        const Vector3& force, const Vector3& torque) const {
  const int carrier = world.storage.units[model.index].carrier;
  if (carrier >= 0) {
    Model& below = world.models.of(world.fleet.robots[carrier]);
    return below.owner->push(world, below, 0, at, force, torque);
  }
  letFall(world, model);
  return OrdinaryModels().push(world, model, link, at, force, torque);
}

/// Builds the body with the mass of the unit's items.
ModelBodies StorageUnits::build(const Scene& world, const Model& model) const {
  const StorageUnit& unit = world.storage.units[model.index];
  ModelDescription loaded = *model.description;
  const double own = massOf(loaded);
  for (Link& link : loaded.links) {
    link.mass *= unit.mass / own;
    link.principal_moments *= unit.mass / own;
  }
  ModelBodies bodies = model.upright
                           ? buildUpright(world, model, loaded)
                           : world.physics.build(loaded, model.pose, model.slot, kDynamicGroup, ~0);
  for (LinkBody& link : bodies.links) link.body->setActivationState(ISLAND_SLEEPING);
  return bodies;
}

bool StorageUnits::mayBeUpright(const Scene& world, const Model& model) const {
  return canSlideUpright(world, model) && standsUpright(world, model.index);
}

/// Takes the unit over from Bullet, upright on its legs.
void StorageUnits::deactivated(RobotView& world, Model& model) const {
  if (model.disturbed) {
    const Pose pose = unitPose(world, model.index);
    model.pose = Pose(pose.X(), pose.Y(), world.floor.extent.z, 0, 0, pose.Rot().Yaw());
  }
  model.disturbed = false;
}

/// A unit that was pushed leaves as soon as it is at rest: otherwise it and a robot beside it would
/// keep each other in Bullet.
bool StorageUnits::mayLeaveBullet(const Scene& world, const Model& model, bool is_alone) const {
  if (!model.disturbed) return is_alone;
  const bool rests = model.bodies.links.front().body->getDeactivationTime() > kResting;
  return (is_alone || rests) && standsStill(world, model);
}

/// Makes the pose of its body the unit's own from now on.
void StorageUnits::touched(MotionView& world, Model& model) const {
  if (model.disturbed || world.storage.units[model.index].carrier >= 0) return;
  model.disturbed = true;
  moved(world, model);
}

int StorageUnits::robot(const Scene& world, const Model& model) const {
  return world.storage.units[model.index].carrier;
}

/// Returns whether the unit stops that robot: a robot without a load passes beneath a standing
/// unit.
bool StorageUnits::stops(const Scene& world, const Model& model, int robot) const {
  return world.fleet.unit[robot] >= 0 || world.storage.units[model.index].carrier >= 0;
}

}  // namespace kiva
