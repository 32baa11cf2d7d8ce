// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parts.h"

namespace kiva {

/// Adds one model with all it needs, or throws DescriptionError and leaves nothing of it.
void spawnModel(Parts& parts, const ModelInstance& instance);
void removeModel(Parts& parts, int slot);
/// Puts a model there with that velocity, as a hand would.
void placeModel(Parts& parts, int slot, const EntityState& state);
/// Back to where it was spawned, at rest.
void resetModel(Parts& parts, int slot);
EntityState modelState(const Parts& parts, const Model& model);
std::optional<EntityState> linkState(const Parts& parts, const Model& model,
                                     const std::string& link);
/// Slots in order of arrival.
std::vector<int> slotsInOrder(const Parts& parts);

/// A model's bodies as they are when it enters Bullet.
ModelBodies buildBodies(const Parts& parts, int slot);
/// Gives a model the outlines of its shapes, without footprints so far.
void addOutlines(Model& model);
/// Writes the footprints of a model anew, from where its links are now.
void updateOutlines(Parts& parts, Model& model);
/// The robot that the model is or is carried by, -1 = none.
int moverOf(const Parts& parts, const Model& model);
/// Calls visit(footprint) for each of the model's footprints in world.
template <typename Visit>
void forFootprints(const Parts& parts, int slot, Visit visit) {
  const int mover = moverOf(parts, *parts.models[slot]);
  if (mover < 0) {
    for (const Outline& o : parts.models[slot]->outlines) visit(parts.obstacles[o.handle]);
    return;
  }
  for (const Footprint& footprint : parts.obstacles.footprints(mover)) {
    if (footprint.model == slot) visit(footprint);
  }
}
/// Links' poses without bodies: those of a standing model at `pose`.
Pose linkPose(const Parts& parts, const Model& model, int link);

}  // namespace kiva
