// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "kiva_plugin_cpp/world.h"

namespace kiva {

class FloorCover;

/// A rectangle of the floor that grips otherwise than the rest, in world [m].
struct FloorPatch {
  double min_x = 0, max_x = 0, min_y = 0, max_y = 0;
  double friction = 0;  ///< Coulomb coefficient of its surface.

  bool has(double x, double y) const {
    return x >= min_x && x <= max_x && y >= min_y && y <= max_y;
  }
  bool meets(const FloorPatch& o) const {
    return o.min_x <= max_x && o.max_x >= min_x && o.min_y <= max_y && o.max_y >= min_y;
  }
};

/// The floor that all static models make together.
struct FloorState {
  Floor extent;                             ///< Height and bounds.
  double friction = 1;                      ///< Coulomb coefficient of the largest surface.
  std::shared_ptr<const FloorCover> cover;  ///< Null where all surfaces grip alike.
  bool cover_due = true;            ///< Floor or robots have changed since the cover was found.
  std::vector<FloorPatch> patches;  ///< Where the friction is another one; later ones lie on top.
};

}  // namespace kiva
