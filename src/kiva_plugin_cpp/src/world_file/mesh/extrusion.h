// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// A point of a polygon [m].
struct Vector2 {
  double x = 0, y = 0;
};

/// Adds the prism over a simple polygon of either orientation, from z = 0 to `height` [m], to
/// `mesh`. Returns false if the points span no area.
bool extrude(std::vector<Vector2> points, double height, Mesh* mesh);

}  // namespace kiva
