// SPDX-License-Identifier: Apache-2.0
//
// Applies the forces of clients to links and joints, for one step or a period.
#pragma once

#include <string>

#include "core/state/views/contact_view.h"

namespace kiva {

/// Applies the forces that are due before a step, and drops those whose period is over.
void applyExternalWrenches(ContactView& world);
/// Applies a force on the link's centre of mass and a torque for the next step, in world. Returns
/// false if the link does not move.
bool pushLink(ContactView& world, Model& model, int link, const Vector3& force,
              const Vector3& torque);
/// Forgets the forces on a model that is removed.
void forgetExternalInputs(ExternalInputs& external_inputs, const std::string& model);

}  // namespace kiva
