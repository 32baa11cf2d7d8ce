// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/robots/failure_state.h"
#include "core/state/robots/scans.h"
#include "core/state/views/contact_view.h"
#include "core/state/world/plugins.h"

namespace kiva {

/// What changes as models come, go and are moved: the floor that static models make, and what is
/// known about a model elsewhere.
struct ModelView : ContactView {
  Settings& settings;  ///< The first robot may bring the world's realism.
  FloorState& floor;
  FallenItems& fallen;
  People& people;
  FailureState& failures;
  Scans& scans;
  const Plugins& plugins;
};

}  // namespace kiva
