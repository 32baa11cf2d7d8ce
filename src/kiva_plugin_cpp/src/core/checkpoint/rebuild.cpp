// SPDX-License-Identifier: Apache-2.0
#include "core/checkpoint/rebuild.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "core/checkpoint/archive.h"
#include "core/motion/joints/joints.h"
#include "core/state/places/footprints.h"
#include "core/state/places/poses.h"

namespace kiva {
namespace {

/// The addresses of bodies. For look-up only, since its order depends on pointers.
using Addresses = std::unordered_map<const btCollisionObject*, BodyAddress>;

Addresses addresses(const WorldState& world) {
  Addresses out;
  for (std::size_t slot = 0; slot < world.models.size(); ++slot) {
    if (!world.models[slot] || !world.models[slot]->in_physics) continue;
    const ModelBodies& bodies = world.models[slot]->bodies;
    for (const auto* list : {&bodies.links, &bodies.surfaces}) {
      for (std::size_t i = 0; i < list->size(); ++i) {
        out[(*list)[i].body.get()] = {static_cast<int>(slot), static_cast<int>(i),
                                      list == &bodies.surfaces};
      }
    }
  }
  return out;
}

/// Returns the rank of a model in Bullet's order of arrival; a model's bodies arrive together.
int arrivalOf(const Model& model) {
  if (model.bodies.links.empty()) return -1;
  return model.bodies.links.front().body->getBroadphaseHandle()->getUid();
}

std::vector<int> slotsInPhysics(const WorldState& world) {
  std::vector<int> slots;
  for (std::size_t slot = 0; slot < world.models.size(); ++slot) {
    if (world.models[slot] && world.models[slot]->in_physics) {
      slots.push_back(static_cast<int>(slot));
    }
  }
  std::sort(slots.begin(), slots.end(), [&world](int a, int b) {
    return arrivalOf(*world.models[a]) < arrivalOf(*world.models[b]);
  });
  return slots;
}

ModelInPhysics readModel(const WorldState& world, int slot) {
  ModelInPhysics out;
  out.slot = slot;
  const Model& model = *world.models[slot];
  if (model.isStatic()) return out;
  for (const LinkBody& link : model.bodies.links) out.links.push_back(readBody(*link.body));
  for (const auto& joint : model.bodies.joints) out.motors.push_back(readMotor(*joint));
  return out;
}

std::vector<ContactMemory> readContacts(const WorldState& world) {
  const std::vector<btPersistentManifold*> manifolds = world.physics.manifolds();
  std::vector<ContactMemory> out;
  if (manifolds.empty()) return out;
  const Addresses address = addresses(world);
  for (const btPersistentManifold* manifold : manifolds) {
    ContactMemory memory{address.at(manifold->getBody0()),
                         address.at(manifold->getBody1()),
                         manifold->m_companionIdA,
                         manifold->m_companionIdB,
                         {}};
    for (int i = 0; i < manifold->getNumContacts(); ++i) {
      memory.points.push_back(manifold->getContactPoint(i));
    }
    out.push_back(std::move(memory));
  }
  return out;
}

auto keyOf(const BodyAddress& a, const BodyAddress& b, int part_a, int part_b) {
  return std::make_tuple(a.model, a.link, a.is_surface, b.model, b.link, b.is_surface, part_a,
                         part_b);
}

/// A contact without a manifold, whose bodies parted in the last step, would be dropped at the
/// beginning of the next, so it is not saved.
void writeContacts(WorldState& world, const std::vector<ContactMemory>& memories) {
  if (memories.empty()) return;
  std::map<decltype(keyOf({}, {}, 0, 0)), const ContactMemory*> memory_of;
  for (const ContactMemory& m : memories) memory_of[keyOf(m.a, m.b, m.part_a, m.part_b)] = &m;
  const Addresses address = addresses(world);
  for (btPersistentManifold* manifold : world.physics.makeManifolds()) {
    const auto memory =
        memory_of.find(keyOf(address.at(manifold->getBody0()), address.at(manifold->getBody1()),
                             manifold->m_companionIdA, manifold->m_companionIdB));
    if (memory == memory_of.end()) continue;
    for (const btManifoldPoint& point : memory->second->points) manifold->addManifoldPoint(point);
  }
}

void buildModel(WorldState& world, const ModelInPhysics& state) {
  Model& model = *world.models.slots.at(state.slot);
  model.bodies = model.owner->build(world.view, model);
  if (!model.isStatic() && (state.links.size() != model.bodies.links.size() ||
                            state.motors.size() != model.bodies.joints.size())) {
    throw std::invalid_argument("'" + model.name + "' has other bodies than its model");
  }
  for (std::size_t i = 0; i < state.links.size(); ++i) {
    writeBody(state.links[i], *model.bodies.links[i].body);
  }
  world.physics.insert(model.bodies);
  restoreLimits(model);
  for (std::size_t i = 0; i < state.motors.size(); ++i) {
    writeMotor(state.motors[i], *model.bodies.joints[i]);
  }
}

/// A model that Bullet has not touched keeps the footprints from before its entry.
void addFootprints(WorldState& world, Model& model) {
  const bool is_in = model.in_physics;
  if (model.owner->isActivatedWhenNear() && !model.disturbed) model.in_physics = false;
  moved(world.view, model);
  model.in_physics = is_in;
}

/// Sets the footprints of robots and loads to those of the checkpoint. Footprints computed from the
/// present poses would have other rounding errors.
void setMovers(Obstacles& obstacles, const PhysicsState& state) {
  for (std::size_t robot = 0; robot < state.movers.size(); ++robot) {
    obstacles.setMover(static_cast<int>(robot), state.movers[robot]);
  }
}

void rebuildObstacles(WorldState& world, const PhysicsState& state) {
  for (int slot : world.models.inOrder()) {
    Model& model = *world.models[slot];
    const bool is_touched = model.in_physics || model.owner->isActivatedWhenNear();
    if (model.geometries.empty() && is_touched) addCollisionGeometry(world.view.floor, model);
    addFootprints(world, model);
  }
  setMovers(world.obstacles, state);
}

/// Returns whether each of its shapes has a footprint of its own.
bool isPlaced(const Model& model) {
  return std::all_of(model.geometries.begin(), model.geometries.end(),
                     [](const CollisionGeometry& geometry) { return geometry.handle >= 0; });
}

/// Renews the footprints of a model that moved or changed. Robots and their loads get theirs from
/// setMovers(); an item on a unit has none.
void renewFootprints(WorldState& world, Model& model, const Standing& before) {
  const bool is_activatable = model.owner->isActivatedWhenNear();
  if (!model.in_physics && !is_activatable) {
    hideFootprints(world.obstacles, model);
    model.geometries.clear();
  } else if (model.owner->robot(world.view, model) >= 0) {
    hideFootprints(world.obstacles, model);
  } else {
    const bool stood = !before.in_physics && !model.in_physics && isPlaced(model) &&
                       before.pose == numbersOf(model.pose);
    if (stood) return;
    if (model.geometries.empty()) addCollisionGeometry(world.view.floor, model);
    addFootprints(world, model);
  }
}

/// Returns whether all static models precede the others in Bullet: rebuildMovable() can only
/// append.
bool fixturesCameFirst(const WorldState& world, const PhysicsState& state) {
  const auto is_static = [&](const ModelInPhysics& model) {
    return world.models[model.slot]->isStatic();
  };
  return std::is_partitioned(state.models.begin(), state.models.end(), is_static);
}

}  // namespace

PhysicsState readPhysics(const WorldState& world) {
  PhysicsState state;
  for (int slot : slotsInPhysics(world)) state.models.push_back(readModel(world, slot));
  state.contacts = readContacts(world);
  for (int robot = 0; robot < world.fleet.size(); ++robot) {
    state.movers.push_back(world.obstacles.ofMover(robot));
  }
  return state;
}

void rebuild(WorldState& world, const PhysicsState& state) {
  world.physics.setGravity(world.settings.gravity);
  for (const ModelInPhysics& model : state.models) buildModel(world, model);
  writeContacts(world, state.contacts);
  rebuildObstacles(world, state);
  if (!fixturesCameFirst(world, state)) world.origin = CheckpointOrigin();
  world.origin.fixtures = world.physics.fixtureChanges();
}

std::vector<Standing> clearPhysics(WorldState& world) {
  std::vector<Standing> stood(world.models.size());
  for (auto& model : world.models) {
    if (!model || model->isStatic()) continue;
    stood[model->slot] = {numbersOf(model->pose), model->in_physics};
    model->jointed.reset();
    if (!model->in_physics) continue;
    world.physics.remove(model->bodies);
    model->bodies = ModelBodies();
  }
  return stood;
}

void rebuildMovable(WorldState& world, const PhysicsState& state,
                    const std::vector<Standing>& before) {
  for (const ModelInPhysics& model : state.models) {
    if (!world.models[model.slot]->isStatic()) buildModel(world, model);
  }
  writeContacts(world, state.contacts);
  for (auto& model : world.models) {
    if (model && !model->isStatic()) renewFootprints(world, *model, before[model->slot]);
  }
  setMovers(world.obstacles, state);
}

}  // namespace kiva
