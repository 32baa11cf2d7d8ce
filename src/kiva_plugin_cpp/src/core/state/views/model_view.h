// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/robots/failure_state.h"
#include "core/state/robots/scans.h"
#include "core/state/views/contact_view.h"

namespace kiva {

/// Writes everything that changes as models come, go and are moved: beside contact, the floor that
/// static models make, and the entries about a model elsewhere.
struct ModelView : ContactView {
  WorldSettings& settings;  ///< The first robot may bring the world's realism.
  FloorState& floor;
  FallenItems& fallen;
  People& people;
  FailureState& failures;
  Scans& scans;
};

}  // namespace kiva
