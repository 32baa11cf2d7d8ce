// SPDX-License-Identifier: Apache-2.0
#include <ignition/plugin/Loader.hh>
#include <stdexcept>

#include "warehouse_fleet/planner.h"

namespace fleet {

std::shared_ptr<Planner> loadPlanner(const std::string& path, const std::string& class_name) {
  // Never unloaded: planners of it may live as long as the program.
  static ignition::plugin::Loader loader;
  const auto found = loader.LoadLib(path);
  if (found.empty()) {
    throw std::runtime_error(path + ": no library with a registered planner");
  }
  std::string names;
  for (const std::string& name : found) names += (names.empty() ? "" : ", ") + name;
  if (!found.count(class_name)) {
    throw std::runtime_error(path + ": no class " + class_name + "; it has " + names);
  }
  auto planner = loader.Instantiate(class_name)->QueryInterfaceSharedPtr<Planner>();
  if (planner == nullptr) {
    throw std::runtime_error(path + ": " + class_name +
                             " is not registered as a fleet::Planner (IGNITION_ADD_PLUGIN)");
  }
  return planner;
}

}  // namespace fleet
