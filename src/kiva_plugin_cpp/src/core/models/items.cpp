// SPDX-License-Identifier: Apache-2.0
#include "core/models/items.h"

#include <algorithm>
#include <utility>

#include "core/models/load.h"
#include "core/motion/dynamics.h"
#include "core/state/places/footprints.h"
#include "core/state/places/poses.h"
#include "core/state/places/unit_geometry.h"

namespace kiva {
namespace {

bool liesOnUnit(const Storage& storage, const Model& model) {
  return storage.items[model.index].unit >= 0;
}

template <typename View>
auto& unitBelow(View& world, const Model& model) {
  return *world.models[world.storage.units[world.storage.items[model.index].unit].model];
}

/// Returns the unit that an item lies on. A unit that was raised onto the floor takes along the
/// items that would lie on it without that.
int findUnit(const Scene& world, Model& item) {
  const Vector3 lift(0, 0, std::max(0.0, world.floor.extent.z));
  const int raised = unitAt(world, item.pose.Pos() + lift);
  if (raised < 0 || world.storage.units[raised].raised == 0) return unitAt(world, item.pose.Pos());
  item.pose.Pos().Z() += world.storage.units[raised].raised;
  return raised;
}

}  // namespace

std::uint8_t Items::occupies(const Scene& world, const Model& model) const {
  if (liesOnUnit(world.storage, model)) return Occupancy::kFree;
  const OffShelf* off = world.fallen.find(model.slot);
  return off && off->lies ? Occupancy::kTaken : Occupancy::kFree;
}

void Items::add(ModelView& world, Model& model) const {
  Item item;
  item.name = model.name;
  item.id = numberIn(model.name, "item");
  item.model = model.slot;
  item.mass = massOf(*model.description);
  item.unit = findUnit(world, model);
  if (item.unit >= 0) item.pose_in_unit = unitPose(world, item.unit).Inverse() * model.pose;
  item.spawn_pose_in_unit = item.pose_in_unit;
  model.index = static_cast<int>(world.storage.items.size());
  world.storage.items.push_back(item);
  world.storage.lay(model.index);
  if (item.unit >= 0) {
    addMass(world, item.unit, item.mass);
  } else {
    OrdinaryModels::add(world, model);
  }
}

void Items::remove(ModelView& world, Model& model) const {
  OrdinaryModels::remove(world, model);
  if (model.index < 0) return;  // it never joined the items
  const Item gone = world.storage.items[model.index];
  const int last = static_cast<int>(world.storage.items.size()) - 1;
  world.storage.take(model.index);
  if (model.index != last) {
    world.storage.take(last);
    world.storage.items[model.index] = std::move(world.storage.items[last]);
    world.storage.lay(model.index);
    world.models[world.storage.items[model.index].model]->index = model.index;
  }
  world.storage.items.pop_back();
  if (gone.unit >= 0) addMass(world, gone.unit, -gone.mass);
  world.storage.noteMove();
}

void Items::place(ModelView& world, Model& model, const EntityState& state) const {
  if (!liesOnUnit(world.storage, model)) return OrdinaryModels::place(world, model, state);
  Item& item = world.storage.items[model.index];
  item.pose_in_unit = unitPose(world, item.unit).Inverse() * state.pose;
}

/// An item on a unit follows the unit.
void Items::reset(ModelView& world, Model& model) const {
  if (!liesOnUnit(world.storage, model)) return OrdinaryModels::reset(world, model);
  Item& item = world.storage.items[model.index];
  item.pose_in_unit = item.spawn_pose_in_unit;
}

EntityState Items::state(const Scene& world, const Model& model) const {
  if (!liesOnUnit(world.storage, model)) return OrdinaryModels::state(world, model);
  return carriedState(modelState(world, unitBelow(world, model)), itemPose(world, model.index));
}

Pose Items::linkPose(const Scene& world, const Model& model, int link) const {
  if (!liesOnUnit(world.storage, model)) return OrdinaryModels::linkPose(world, model, link);
  return itemPose(world, model.index) * model.description->links[link].pose_in_model;
}

void Items::reweigh(ContactView& world, Model& model, double added) const {
  Item& item = world.storage.items[model.index];
  item.mass += added;
  if (item.unit >= 0) return addMass(world, item.unit, added);
  OrdinaryModels::reweigh(world, model, added);
}

bool Items::push(ContactView& world, Model& model, int link, const Vector3& at,
                 const Vector3& force, const Vector3& torque) const {
  if (!liesOnUnit(world.storage, model)) {
    return OrdinaryModels::push(world, model, link, at, force, torque);
  }
  Model& unit = unitBelow(world, model);
  return unit.owner->push(world, unit, 0, at, force, torque);
}

void fallOff(ModelView& world, Model& model, const EntityState& state) {
  Item& item = world.storage.items[model.index];
  const int unit = item.unit;
  world.storage.take(model.index);
  item.unit = -1;
  addMass(world, unit, -item.mass);
  OrdinaryModels().add(world, model);
  OrdinaryModels().place(world, model, state);
  moved(world, model);
  invalidateClearance(world.fleet);
  ++world.models.revision;
}

void putBack(ModelView& world, Model& model, const Model& unit) {
  OrdinaryModels().remove(world, model);
  world.physics.remove(model.bodies);
  model.bodies = ModelBodies();
  model.in_physics = false;
  hideFootprints(world.obstacles, model);
  model.geometries.clear();
  Item& item = world.storage.items[model.index];
  item.unit = unit.index;
  world.storage.lay(model.index);
  addMass(world, item.unit, item.mass);
  world.storage.noteMove();
  invalidateClearance(world.fleet);
  wakeBodies(world.models);  // bodies on top of it fall
  ++world.models.revision;
}

void forgetFallen(FallenItems& fallen, int slot) {
  auto& all = fallen.items;
  const auto is_of = [slot](const OffShelf& o) { return o.item == slot || o.unit == slot; };
  all.erase(std::remove_if(all.begin(), all.end(), is_of), all.end());
}

void putAllBack(ModelView& world) {
  for (const OffShelf& off : world.fallen.items) {
    if (off.lies) putBack(world, *world.models[off.item], *world.models[off.unit]);
  }
  world.fallen.items.clear();
}

}  // namespace kiva
