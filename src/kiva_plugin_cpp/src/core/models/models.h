// SPDX-License-Identifier: Apache-2.0
//
// Adds, removes and places models.
#pragma once

#include "core/state/views/model_view.h"

namespace kiva {

/// Returns the owner of the models of that kind.
const ModelOwner& ownerOf(ModelKind kind);

/// Adds one model with all that it needs. Throws DescriptionError and leaves nothing of it.
void spawnModel(ModelView& world, const ModelInstance& instance);
/// Removes a model, and all models that it carries.
void removeModel(ModelView& world, int slot);
/// Places a model with that velocity, by hand. Throws DescriptionError if the state is not finite
/// or out of bounds.
void placeModel(ModelView& world, Model& model, const EntityState& state);
/// Places one link, with everything that joints hold to it.
void placeLink(ModelView& world, Model& model, int link, const EntityState& state);
/// Sets mass, centre of mass, inertia and gravity flag of the link of that index.
void reweighLink(ContactView& world, Model& model, int link, const Link& like);
/// Returns a model to its spawn pose, at rest.
void resetModel(ModelView& world, Model& model);

/// Loads the plugins of a model and of its sensors, except those that come with the world. Throws
/// DescriptionError.
void loadPlugins(TaskView& world, Model& model);
/// Returns the contacts of a model; see World::contacts.
std::vector<ContactPoint> contactsOf(const Scene& world, int slot);

}  // namespace kiva
