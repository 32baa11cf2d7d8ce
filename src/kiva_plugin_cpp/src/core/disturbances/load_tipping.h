// SPDX-License-Identifier: Apache-2.0
//
// Tips loads off robots that brake or are hit too hard; does nothing while the world's realism has
// no loads.
#pragma once

#include "core/state/views/model_view.h"

namespace kiva {

/// Tilts the loads by the robots' motion in the last step. A load that tips over its edge becomes a
/// body of its own (TIPPED), and its robot stops.
void stepLoadTipping(ModelView& world);

}  // namespace kiva
