// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// The contents of an SDF `<mesh>`.
struct MeshRequest {
  std::string file;  ///< Path.
  Vector3 scale{1, 1, 1};
  std::string submesh;      ///< Name of the part to read; empty: all parts.
  bool is_centred = false;  ///< Whether the submesh is moved to centre its box on the origin.
};

/// Returns the triangles of a COLLADA, Wavefront OBJ or STL file, in metres. COLLADA's unit is
/// applied; its up axis is not, as in Gazebo, for which the models are made. A file is read once
/// and shared while it does not change. Thread-safe. Throws DescriptionError with the cause,
/// without the file's name.
std::shared_ptr<const Mesh> readMesh(const MeshRequest& request);

/// Sets the box around the vertices.
void measure(Mesh* mesh);

}  // namespace kiva
