// SPDX-License-Identifier: Apache-2.0
#include <ignition/plugin/Loader.hh>
#include <stdexcept>

#include "warehouse_fleet/planner.h"

namespace fleet {
namespace {

std::string withoutNamespace(const std::string& name) {
  const std::size_t end = name.rfind("::");
  return end == std::string::npos ? name : name.substr(end + 2);
}

}  // namespace

std::shared_ptr<Planner> loadPlanner(const std::string& path, const std::string& class_name) {
  // Never unloaded: planners of it may live as long as the program.
  static ignition::plugin::Loader loader;
  const auto found = loader.LoadLib(path);
  if (found.empty()) {
    throw std::runtime_error(path + ": no library with a registered planner");
  }
  std::string names, full_name;
  for (const std::string& name : found) {
    names += (names.empty() ? "" : ", ") + name;
    if (withoutNamespace(name) == withoutNamespace(class_name)) full_name = name;
  }
  if (full_name.empty()) {
    throw std::runtime_error(path + ": no class " + class_name + "; it has " + names);
  }
  auto planner = loader.Instantiate(full_name)->QueryInterfaceSharedPtr<Planner>();
  if (planner == nullptr) {
    throw std::runtime_error(path + ": " + class_name +
                             " is not registered as a fleet::Planner (IGNITION_ADD_PLUGIN)");
  }
  return planner;
}

}  // namespace fleet
