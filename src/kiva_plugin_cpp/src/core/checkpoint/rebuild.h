// SPDX-License-Identifier: Apache-2.0
//
// Bullet and the obstacles remember how they came to be: the order of lists, boxes grown in
// advance, contacts of the last step. Building them anew, from what a checkpoint holds and in an
// order that it tells, makes a world that goes on and one that is restored the same, bit by bit.
#pragma once

#include <vector>

#include "core/state/world_state.h"

namespace kiva {

/// A body as Bullet leaves it after a step. In world, SI units.
struct BodyState {
  btTransform pose, predicted_pose;
  btVector3 velocity, angular_velocity;
  btVector3 predicted_velocity, predicted_angular_velocity;
  btVector3 force, torque;  ///< For the next step.
  int activation = 0;
  double resting = 0;  ///< Since it moved last [s].
};

/// One body: of the model in that slot, its link of that index.
struct BodyAddress {
  int model = -1;
  int link = 0;
  bool is_plane = false;
};

/// Contact points that Bullet keeps for a pair of bodies, and starts its solver from.
struct ContactMemory {
  BodyAddress a, b;
  std::vector<btManifoldPoint> points;
};

/// What is to be kept of Bullet.
struct PhysicsState {
  std::vector<std::vector<BodyState>> bodies;  ///< By slot; empty where nothing moves in Bullet.
  std::vector<ContactMemory> contacts;
};

PhysicsState readPhysics(const WorldState& world);

/// Builds Bullet's world and the obstacles anew, and puts `state` into them.
void renew(WorldState& world, const PhysicsState& state);

}  // namespace kiva
