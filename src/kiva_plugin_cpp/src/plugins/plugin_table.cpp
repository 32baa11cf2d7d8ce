// SPDX-License-Identifier: Apache-2.0
#include "plugins/plugin_table.h"

#include "plugins/laser.h"
#include "plugins/lift.h"
#include "plugins/motion.h"
#include "plugins/rotation.h"

namespace kiva {

std::vector<std::shared_ptr<const FleetPlugin>> makeFleetPlugins() {
  std::vector<std::shared_ptr<const FleetPlugin>> table;
  table.push_back(std::make_shared<MotionPlugin>());
  table.push_back(std::make_shared<RotationPlugin>());
  table.push_back(std::make_shared<LiftPlugin>());
  table.push_back(std::make_shared<LaserPlugin>());
  return table;
}

}  // namespace kiva
