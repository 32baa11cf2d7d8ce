// SPDX-License-Identifier: Apache-2.0
//
// What models look like, for viewers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Primitives fixed to a model's links, all joints at zero. Poses are x y z [m] qx qy qz qw.
struct Look {
  /// Of a shape; a mesh is boxes, where it is seen from above and as high as it is there.
  enum Kind : std::uint8_t { kBox, kSphere, kCylinder, kCapsule, kEllipsoid, kPlane };

  std::vector<std::string> links;
  std::vector<double> link_pose;  ///< 7 numbers a link, in the model.
  // Of shapes.
  std::vector<std::int32_t> shape_link;  ///< Index into links.
  std::vector<std::uint8_t> shape_kind;  ///< A Kind.
  std::vector<double> shape_pose;        ///< 7 numbers a shape, in its link.
  std::vector<double> shape_size;        ///< 3 numbers a shape: full extent along its own axes [m].
  std::vector<float> shape_colour;  ///< 4 numbers a shape: red green blue alpha, each in 0…1.
};

/// By a model's visuals; where it has none at all, by what touches.
Look lookOf(const ModelDescription& model);

}  // namespace kiva
