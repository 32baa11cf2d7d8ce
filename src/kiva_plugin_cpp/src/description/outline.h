// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// A box along the axes [m].
struct OutlineBox {
  Vector3 centre, size;
};

/// Returns the boxes that a mesh at `pose` covers, seen from above, each with the range of heights
/// there. The boxes stand upright beside each other and measure at least 2 cm, or a 128th of the
/// mesh's longer side. Parts higher than a robot with its load are left out, so that a roof hides
/// nothing, unless the mesh has no other part.
std::vector<OutlineBox> outlineOf(const Mesh& mesh, const Pose& pose);

}  // namespace kiva
