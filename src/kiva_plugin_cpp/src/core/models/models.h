// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// Adds one model with all it needs, or throws DescriptionError and leaves nothing of it.
void spawnModel(WorldState& world, const ModelInstance& instance);
void removeModel(WorldState& world, int slot);
/// Puts a model there with that velocity, as a hand would.
void placeModel(WorldState& world, int slot, const EntityState& state);
/// The same for one link, and what joints hold to it.
void placeLink(WorldState& world, int slot, int link, const EntityState& state);
/// Another mass, centre of mass, inertia and gravity flag for the link of that index.
void reweighLink(WorldState& world, int slot, int link, const Link& like);
/// Leaves a storage unit to Bullet until it stands on its legs again.
void letFall(WorldState& world, Model& model);
/// Something has come or was moved: all robots look around again before they go on.
void alarm(WorldState& world);
/// Bodies that sleep look again whether they should.
void wakeBodies(WorldState& world);
/// Where a model touches others; see World::contacts.
std::vector<ContactPoint> contactsOf(const WorldState& world, int slot);
/// Back to where it was spawned, at rest.
void resetModel(WorldState& world, int slot);
EntityState modelState(const WorldState& world, const Model& model);
std::optional<EntityState> linkState(const WorldState& world, const Model& model,
                                     const std::string& link);
/// Slots in order of arrival.
std::vector<int> slotsInOrder(const WorldState& world);

/// Loads the plugins of a model and of its sensors, but for those that come with the world.
/// Throws DescriptionError.
void loadPlugins(WorldState& world, Model& model);
/// A model's bodies as they are when it enters Bullet.
ModelBodies buildBodies(const WorldState& world, int slot);
/// Gives a model the geometries of its shapes, without footprints so far.
void addCollisionGeometry(const WorldState& world, Model& model);
/// The same for a static model that has them already, once it or the floor is elsewhere.
void refitGeometry(WorldState& world, Model& model);
/// The group of an ordinary model's footprints: its own rays pass them.
inline int ownGroup(int slot) { return kMaxKivaId + 1 + slot; }
/// Writes the footprints of a model anew, from where its links are now.
void updateFootprints(WorldState& world, Model& model);
/// The robot that the model is or is carried by, -1 = none.
int moverOf(const WorldState& world, const Model& model);
/// Calls visit(footprint) for each of the model's footprints in world.
template <typename Visit>
void forFootprints(const WorldState& world, int slot, Visit visit) {
  const int mover = moverOf(world, *world.models[slot]);
  if (mover < 0) {
    for (const CollisionGeometry& o : world.models[slot]->geometries)
      visit(world.obstacles[o.handle]);
    return;
  }
  for (const Footprint& footprint : world.obstacles.footprints(mover)) {
    if (footprint.model == slot) visit(footprint);
  }
}
/// Links' poses without bodies: those of a standing model at `pose`.
Pose linkPose(const WorldState& world, const Model& model, int link);

}  // namespace kiva
