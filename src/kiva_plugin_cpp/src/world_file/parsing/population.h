// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "world_file/files/xml.h"

namespace kiva {

/// A `<population>`: a pattern and the poses of its clones.
struct Population {
  const XmlElement* pattern = nullptr;  ///< A `<model>` or an `<include>`.
  std::string name;                     ///< Name of the pattern; clones are `name_clone_0`, …
  std::vector<Pose> poses;              ///< Poses of the clones in world.
};

/// Reads a `<population>`; random places are the same each time. Throws DescriptionError with the
/// cause.
Population readPopulation(const XmlElement& population);

}  // namespace kiva
