// SPDX-License-Identifier: Apache-2.0
//
// The shapes of models, for viewers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Primitives fixed to a model's links, all joints at zero. Poses are x y z [m] qx qy qz qw.
struct Look {
  /// The kind of a shape. A mesh is shown as boxes: its outline from above, with its heights.
  enum Kind : std::uint8_t { kBox, kSphere, kCylinder, kCapsule, kEllipsoid, kPlane };

  std::vector<std::string> links;
  std::vector<double> link_pose;  ///< Poses in the model, 7 numbers a link.
  // The following have an entry, or several numbers, for each shape.
  std::vector<std::int32_t> shape_link;  ///< Index into links.
  std::vector<std::uint8_t> shape_kind;  ///< A Kind.
  std::vector<double> shape_pose;        ///< 7 numbers a shape, in its link.
  std::vector<double> shape_size;        ///< 3 numbers a shape: full extent along its own axes [m].
  std::vector<float> shape_colour;  ///< 4 numbers a shape: red green blue alpha, each in 0…1.
};

/// Returns the look of a model by its visuals; by its collisions if it has no visual.
Look lookOf(const ModelDescription& model);

}  // namespace kiva
