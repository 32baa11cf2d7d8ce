// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parts.h"

namespace kiva {

/// Adds one model with all it needs, or throws DescriptionError and leaves nothing of it.
void spawnModel(Parts& parts, const ModelInstance& instance);
void removeModel(Parts& parts, int slot);
/// Puts a model there with that velocity, as a hand would.
void placeModel(Parts& parts, int slot, const EntityState& state);
/// The same for one link, and what joints hold to it.
void placeLink(Parts& parts, int slot, int link, const EntityState& state);
/// Another mass, centre of mass, inertia and gravity flag for the link of that index.
void reweighLink(Parts& parts, int slot, int link, const Link& like);
/// Leaves a storage unit to Bullet until it stands on its legs again.
void letFall(Parts& parts, Model& model);
/// Something has come or was moved: all robots look around again before they go on.
void alarm(Parts& parts);
/// Bodies that sleep look again whether they should.
void wakeBodies(Parts& parts);
/// Where a model touches others; see World::contacts.
std::vector<ContactPoint> contactsOf(const Parts& parts, int slot);
/// Back to where it was spawned, at rest.
void resetModel(Parts& parts, int slot);
EntityState modelState(const Parts& parts, const Model& model);
std::optional<EntityState> linkState(const Parts& parts, const Model& model,
                                     const std::string& link);
/// Slots in order of arrival.
std::vector<int> slotsInOrder(const Parts& parts);

/// Loads the plugins of a model and of its sensors, but for those that come with the world.
/// Throws DescriptionError.
void loadPlugins(Parts& parts, Model& model);
/// A model's bodies as they are when it enters Bullet.
ModelBodies buildBodies(const Parts& parts, int slot);
/// Gives a model the outlines of its shapes, without footprints so far.
void addOutlines(Model& model);
/// The group of an ordinary model's footprints: its own rays pass them.
inline int ownGroup(int slot) { return kMaxKivaId + 1 + slot; }
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
