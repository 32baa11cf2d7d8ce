// SPDX-License-Identifier: Apache-2.0
//
// Bullet's world and the obstacles are not saved but rebuilt when a world is restored, from what
// their next answers follow from; see ordered_bullet.h.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/physics/physics_state.h"
#include "core/state/world_state.h"

namespace kiva {

/// A model in Bullet; without links and motors if it is static.
struct ModelInPhysics {
  int slot = -1;
  std::vector<BodyState> links;
  std::vector<MotorState> motors;  ///< The joints' motors.
};

/// One body: of the model in that slot, its link of that index.
struct BodyAddress {
  int model = -1;
  int link = 0;
  bool is_surface = false;
};

/// Contact points that Bullet keeps for two parts of bodies, and starts its solver from.
struct ContactMemory {
  BodyAddress a, b;
  int part_a = 0, part_b = 0;
  std::vector<btManifoldPoint> points;
};

/// What is to be kept of Bullet and the obstacles.
struct PhysicsState {
  std::vector<ModelInPhysics> models;  ///< In order of arrival.
  std::vector<ContactMemory> contacts;
  std::vector<std::vector<Footprint>> movers;  ///< By robot: its own and its load's, in its frame.
};

PhysicsState readPhysics(const WorldState& world);

/// Where a model stood, and whether it was in Bullet.
struct Standing {
  std::array<std::uint64_t, 7> pose{};  ///< As numbersOf() has it.
  bool in_physics = false;
};

/// Takes all that can move out of Bullet. Returns where each model stood, by slot.
std::vector<Standing> clearPhysics(WorldState& world);
/// Builds in Bullet what can move, and renews the obstacles that are no longer what they were
/// before clearPhysics(); all that is static is still there.
void rebuildMovable(WorldState& world, const PhysicsState& state,
                    const std::vector<Standing>& before);

/// Builds Bullet's world and the obstacles. Throws std::exception if `state` is of another world.
void rebuild(WorldState& world, const PhysicsState& state);

}  // namespace kiva
