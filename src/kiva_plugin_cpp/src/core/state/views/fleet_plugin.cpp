// SPDX-License-Identifier: Apache-2.0
#include "core/state/views/fleet_plugin.h"

namespace kiva {

const FleetPlugin* findFleetPlugin(const Plugins& plugins, const std::string& filename) {
  for (const auto& plugin : plugins.fleet) {
    if (filename == plugin->filename()) return plugin.get();
  }
  return nullptr;
}

}  // namespace kiva
