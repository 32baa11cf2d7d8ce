// SPDX-License-Identifier: Apache-2.0
//
// Rebuilds Bullet's world and the obstacles, which are not saved, when a world is restored. Their
// next results are the same; see ordered_bullet.h.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/physics/physics_state.h"
#include "core/state/world_state.h"

namespace kiva {

/// The state of a model in Bullet; without links and motors if it is static.
struct ModelInPhysics {
  int slot = -1;
  std::vector<BodyState> links;
  std::vector<MotorState> motors;  ///< The joints' motors.
};

/// The address of a body: the slot of its model, and the index of its link.
struct BodyAddress {
  int model = -1;
  int link = 0;
  bool is_surface = false;
};

/// The contact points that Bullet keeps for two parts of bodies, with which its solver starts.
struct ContactMemory {
  BodyAddress a, b;
  int part_a = 0, part_b = 0;
  std::vector<btManifoldPoint> points;
};

/// The state of Bullet and of the obstacles that a checkpoint keeps.
struct PhysicsState {
  std::vector<ModelInPhysics> models;  ///< In order of arrival.
  std::vector<ContactMemory> contacts;
  std::vector<std::vector<Footprint>>
      movers;  ///< By robot: footprints of the robot and its load, in its frame.
};

PhysicsState readPhysics(const WorldState& world);

/// The pose of a model before clearPhysics(), and whether it was in Bullet.
struct Standing {
  std::array<std::uint64_t, 7> pose{};  ///< The result of numbersOf().
  bool in_physics = false;
};

/// Removes all movable models from Bullet. Returns the previous pose of each model, by slot.
std::vector<Standing> clearPhysics(WorldState& world);
/// Rebuilds all movable models in Bullet, and renews the obstacles that changed since
/// clearPhysics(). All static models are still in Bullet.
void rebuildMovable(WorldState& world, const PhysicsState& state,
                    const std::vector<Standing>& before);

/// Builds Bullet's world and the obstacles. Throws std::exception if `state` belongs to another
/// world.
void rebuild(WorldState& world, const PhysicsState& state);

}  // namespace kiva
