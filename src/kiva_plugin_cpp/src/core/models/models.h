// SPDX-License-Identifier: Apache-2.0
//
// Adds, removes and places models.
#pragma once

#include "core/state/views/model_view.h"

namespace kiva {

/// Returns the owner of the models of that kind.
const ModelOwner& ownerOf(ModelKind kind);

/// Adds one model with all it needs, or throws DescriptionError and leaves nothing of it.
void spawnModel(ModelView& world, const ModelInstance& instance);
/// Removes a model, and its passengers.
void removeModel(ModelView& world, int slot);
/// Puts a model there with that velocity, as a hand would. Throws DescriptionError if the state is
/// not finite or too far away.
void placeModel(ModelView& world, Model& model, const EntityState& state);
/// Puts one link there, with what joints hold to it.
void placeLink(ModelView& world, Model& model, int link, const EntityState& state);
/// Gives the link of that index another mass, centre of mass, inertia and gravity flag.
void reweighLink(ModelView& world, Model& model, int link, const Link& like);
/// Returns a model to its spawn pose, at rest.
void resetModel(ModelView& world, Model& model);

/// Loads the plugins of a model and of its sensors, but for those that come with the world.
/// Throws DescriptionError.
void loadPlugins(ModelView& world, Model& model);
/// Returns where a model touches others; see World::contacts.
std::vector<ContactPoint> contactsOf(const Scene& world, int slot);

}  // namespace kiva
