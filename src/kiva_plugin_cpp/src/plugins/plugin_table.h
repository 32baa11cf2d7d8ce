// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "core/state/views/fleet_plugin.h"

namespace kiva {

/// Returns the plugins that come with the world, in the order in which they act.
std::vector<std::shared_ptr<const FleetPlugin>> makeFleetPlugins();

}  // namespace kiva
