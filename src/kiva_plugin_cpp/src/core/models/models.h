// SPDX-License-Identifier: Apache-2.0
//
// Models come and go, and are moved by hand.
#pragma once

#include "core/state/model_view.h"

namespace kiva {

/// Who answers for the models of that kind.
const ModelOwner& ownerOf(ModelKind kind);

/// Adds one model with all it needs, or throws DescriptionError and leaves nothing of it.
void spawnModel(ModelView& world, const ModelInstance& instance);
/// And what goes with it.
void removeModel(ModelView& world, int slot);
/// Puts a model there with that velocity, as a hand would. Throws DescriptionError if the state is
/// not finite or too far away.
void placeModel(ModelView& world, Model& model, const EntityState& state);
/// The same for one link, and what joints hold to it.
void placeLink(ModelView& world, Model& model, int link, const EntityState& state);
/// Another mass, centre of mass, inertia and gravity flag for the link of that index.
void reweighLink(ModelView& world, Model& model, int link, const Link& like);
/// Back to where it was spawned, at rest.
void resetModel(ModelView& world, Model& model);

/// Loads the plugins of a model and of its sensors, but for those that come with the world.
/// Throws DescriptionError.
void loadPlugins(ModelView& world, Model& model);
/// Where a model touches others; see World::contacts.
std::vector<ContactPoint> contactsOf(const Scene& world, int slot);

}  // namespace kiva
