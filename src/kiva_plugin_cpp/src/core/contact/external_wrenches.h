// SPDX-License-Identifier: Apache-2.0
//
// Forces that clients apply to links and joints, for a step or for a while.
#pragma once

#include <string>

#include "core/state/contact_view.h"

namespace kiva {

/// Before a step: applies what is due now, and drops what is over.
void applyExternalWrenches(ContactView& world);
/// For the next step: a force on the link's centre of mass and a torque, in world. Returns false
/// if the link does not move.
bool pushLink(ContactView& world, Model& model, int link, const Vector3& force,
              const Vector3& torque);
/// A model is going.
void forgetExternalInputs(ExternalInputs& external_inputs, const std::string& model);

}  // namespace kiva
