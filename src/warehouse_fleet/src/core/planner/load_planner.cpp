// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "warehouse_fleet/planner.h"
#include "warehouse_layout/plugin_library.h"

namespace fleet {

std::shared_ptr<Planner> loadPlanner(const std::string& path, const std::string& class_name) {
  const warehouse::PluginLibrary library(path);
  const auto fail = [&path](const std::string& why) {
    throw std::runtime_error(path + ": " + why);
  };
  const std::string contents = library.contents();
  if (contents.empty()) fail("no library with a registered planner");
  const warehouse::PluginClass* const found = library.find(class_name);
  if (!found) fail("no class " + class_name + "; it has " + contents);
  if (!library.is<Planner>(*found)) {
    fail(class_name + " is registered as " + found->interface + "; WAREHOUSE_ADD_PLUGIN(" +
         class_name + ", fleet::Planner) was expected");
  }
  return library.make<Planner>(*found);
}

}  // namespace fleet
