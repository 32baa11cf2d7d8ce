// SPDX-License-Identifier: Apache-2.0
//
// Where things are, in world.
#pragma once

#include <optional>

#include "core/state/world_state.h"

namespace kiva {

/// Of a robot's chassis on the floor.
Pose basePose(const WorldState& world, int robot);
/// Of the tower's plate on which a unit rests.
Pose towerPose(const WorldState& world, int robot);
Pose unitPose(const WorldState& world, int unit);
Pose itemPose(const WorldState& world, int item);

EntityState robotState(const WorldState& world, int robot);
EntityState modelState(const WorldState& world, const Model& model);
Pose linkPose(const WorldState& world, const Model& model, int link);
EntityState linkState(const WorldState& world, const Model& model, int link);

/// What Bullet says of a link.
EntityState bodyState(const LinkBody& link);
/// State of the model's frame, from that of its canonical link in Bullet.
EntityState canonicalState(const Model& model);
/// Of a point that moves with something, without turning against it.
EntityState carriedState(const EntityState& carrier, const Pose& pose);

}  // namespace kiva
