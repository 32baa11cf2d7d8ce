// SPDX-License-Identifier: Apache-2.0
#include "core/checkpoint/rebuild.h"

#include <new>
#include <unordered_map>
#include <utility>

#include "core/contact/activation.h"
#include "core/motion/joints.h"
#include "core/state/footprints.h"
#include "core/state/poses.h"

namespace kiva {
namespace {

BodyState readBody(const btRigidBody& body) {
  BodyState s;
  s.pose = body.getWorldTransform();
  s.predicted_pose = body.getInterpolationWorldTransform();
  s.velocity = body.getLinearVelocity();
  s.angular_velocity = body.getAngularVelocity();
  s.predicted_velocity = body.getInterpolationLinearVelocity();
  s.predicted_angular_velocity = body.getInterpolationAngularVelocity();
  s.force = body.getTotalForce();
  s.torque = body.getTotalTorque();
  s.activation = body.getActivationState();
  s.resting = body.getDeactivationTime();
  return s;
}

void writeBody(const BodyState& s, btRigidBody& body) {
  body.setWorldTransform(s.pose);
  body.setInterpolationWorldTransform(s.predicted_pose);
  body.setLinearVelocity(s.velocity);
  body.setAngularVelocity(s.angular_velocity);
  body.setInterpolationLinearVelocity(s.predicted_velocity);
  body.setInterpolationAngularVelocity(s.predicted_angular_velocity);
  body.updateInertiaTensor();
  body.clearForces();
  body.applyCentralForce(s.force);
  body.applyTorque(s.torque);
  body.forceActivationState(s.activation);
  body.setDeactivationTime(s.resting);
}

bool operator==(const BodyAddress& a, const BodyAddress& b) {
  return a.model == b.model && a.link == b.link && a.is_plane == b.is_plane;
}

/// Whose a body is. Asked only, never gone through: its order is none.
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

std::vector<ContactMemory> readContacts(const WorldState& world) {
  const std::vector<btPersistentManifold*> manifolds = world.physics.manifolds();
  std::vector<ContactMemory> out;
  if (manifolds.empty()) return out;
  const Addresses address = addresses(world);
  for (const btPersistentManifold* manifold : manifolds) {
    // Bullet does not look for contacts of bodies asleep.
    const bool asleep = !manifold->getBody0()->isActive() && !manifold->getBody1()->isActive();
    if (manifold->getNumContacts() == 0 || asleep) continue;
    ContactMemory memory{address.at(manifold->getBody0()), address.at(manifold->getBody1()), {}};
    for (int i = 0; i < manifold->getNumContacts(); ++i) {
      memory.points.push_back(manifold->getContactPoint(i));
    }
    out.push_back(std::move(memory));
  }
  return out;
}

void swapSides(btManifoldPoint& p) {
  std::swap(p.m_localPointA, p.m_localPointB);
  std::swap(p.m_positionWorldOnA, p.m_positionWorldOnB);
  std::swap(p.m_partId0, p.m_partId1);
  std::swap(p.m_index0, p.m_index1);
  p.m_normalWorldOnB = -p.m_normalWorldOnB;
}

/// Whether both are about the same two parts of the same two bodies.
bool isSame(const ContactMemory& a, const ContactMemory& b) {
  return a.a == b.a && a.b == b.b && a.points.front().m_index0 == b.points.front().m_index0 &&
         a.points.front().m_index1 == b.points.front().m_index1;
}

/// Bullet finds the contacts again; their points and impulses are those that it remembered.
void writeContacts(WorldState& world, std::vector<ContactMemory> memories) {
  if (memories.empty()) return;
  world.physics.findContacts();
  const Addresses address = addresses(world);
  for (btPersistentManifold* manifold : world.physics.manifolds()) {
    if (manifold->getNumContacts() == 0) continue;
    const ContactMemory found{address.at(manifold->getBody0()),
                              address.at(manifold->getBody1()),
                              {manifold->getContactPoint(0)}};
    for (ContactMemory& memory : memories) {
      if (memory.a == found.b && memory.b == found.a) {
        std::swap(memory.a, memory.b);
        for (btManifoldPoint& point : memory.points) swapSides(point);
      }
      if (!isSame(memory, found)) continue;
      manifold->clearManifold();
      for (const btManifoldPoint& point : memory.points) manifold->addManifoldPoint(point);
      break;
    }
  }
}

void buildModel(WorldState& world, int slot, const std::vector<BodyState>& states) {
  Model& model = *world.models[slot];
  model.bodies = model.owner->build(world, model);
  for (std::size_t i = 0; i < states.size() && i < model.bodies.links.size(); ++i) {
    writeBody(states[i], *model.bodies.links[i].body);
  }
  world.physics.insert(model.bodies);
  restoreLimits(model);
}

/// First what is in Bullet for good, in the order in which it came, then what visits.
std::vector<int> slotsInPhysics(const WorldState& world) {
  std::vector<int> slots;
  for (int slot : slotsInOrder(world)) {
    const Model& model = *world.models[slot];
    if (model.in_physics && !model.owner->isActivatedWhenNear()) slots.push_back(slot);
  }
  slots.insert(slots.end(), world.activated.begin(), world.activated.end());
  return slots;
}

void rebuildPhysics(WorldState& world, const PhysicsState& state) {
  for (auto& model : world.models) {
    if (model && !model->bodies.links.empty()) world.physics.remove(model->bodies);
  }
  world.physics.~Physics();
  new (&world.physics) Physics(world.gravity);
  for (int slot : slotsInPhysics(world)) buildModel(world, slot, state.bodies[slot]);
  writeContacts(world, state.contacts);
}

void rebuildObstacles(WorldState& world) {
  world.obstacles.clear();
  for (int slot : slotsInOrder(world)) {
    Model& model = *world.models[slot];
    for (CollisionGeometry& geometry : model.geometries) geometry.handle = -1;
    moved(world, model);
  }
}

}  // namespace

PhysicsState readPhysics(const WorldState& world) {
  PhysicsState state;
  state.bodies.resize(world.models.size());
  for (std::size_t slot = 0; slot < world.models.size(); ++slot) {
    const Model* model = world.models[slot].get();
    if (!model || !model->in_physics || model->isStatic()) continue;
    for (const LinkBody& link : model->bodies.links) {
      state.bodies[slot].push_back(readBody(*link.body));
    }
  }
  state.contacts = readContacts(world);
  return state;
}

void renew(WorldState& world, const PhysicsState& state) {
  rebuildPhysics(world, state);
  rebuildObstacles(world);
}

}  // namespace kiva
