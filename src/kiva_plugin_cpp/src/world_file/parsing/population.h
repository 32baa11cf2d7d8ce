// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "world_file/files/xml.h"

namespace kiva {

/// What a `<population>` puts where.
struct Population {
  const XmlElement* pattern = nullptr;  ///< A `<model>` or an `<include>`.
  std::string name;                     ///< Of the pattern; clones are called `name_clone_0`, …
  std::vector<Pose> poses;              ///< Of the clones, in world.
};

/// Reads a `<population>`; random places are the same each time. Throws DescriptionError with the
/// cause.
Population readPopulation(const XmlElement& population);

}  // namespace kiva
