// SPDX-License-Identifier: Apache-2.0
//
// Where things are, in world.
#pragma once

#include <optional>

#include "core/state/views/scene.h"

namespace kiva {

/// Returns the pose of a robot's chassis on the floor.
Pose basePose(const Scene& world, int robot);
/// Returns the pose of the tower's plate on which a unit rests.
Pose towerPose(const Scene& world, int robot);
Pose unitPose(const Scene& world, int unit);
Pose itemPose(const Scene& world, int item);

EntityState robotState(const Scene& world, int robot);
EntityState modelState(const Scene& world, const Model& model);
Pose linkPose(const Scene& world, const Model& model, int link);
EntityState linkState(const Scene& world, const Model& model, int link);

/// Returns what Bullet says of a link.
EntityState bodyState(const LinkBody& link);
/// Returns the state of the model's frame, from that of its canonical link in Bullet.
EntityState canonicalState(const Model& model);
/// Returns the state of a frame at `pose` that is fixed to a moving carrier.
EntityState carriedState(const EntityState& carrier, const Pose& pose);

}  // namespace kiva
