// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// A box along the axes [m].
struct OutlineBox {
  Vector3 centre, size;
};

/// A mesh at that pose as boxes upright beside each other, of 2 cm at least and a 128th of its
/// longer side: where it is, seen from above, and from where to where it reaches in height there.
/// What is higher than a robot with its load is left out, unless that is all: a roof hides nothing.
std::vector<OutlineBox> outlineOf(const Mesh& mesh, const Pose& pose);

}  // namespace kiva
