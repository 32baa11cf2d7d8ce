// SPDX-License-Identifier: Apache-2.0
#include "warehouse_fleet/planner.h"

#include <stdexcept>

namespace fleet {

void Planner::prepare(double /*seconds*/) {}

void Planner::save(const std::string& path) const {
  throw std::runtime_error(path + ": this planner prepares nothing that could be written");
}

void Planner::load(const std::string& path) {
  throw std::runtime_error(path + ": this planner prepares nothing that could be read");
}

}  // namespace fleet
