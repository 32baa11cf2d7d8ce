// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// What an SDF `<mesh>` asks for.
struct MeshRequest {
  std::string file;  ///< Path.
  Vector3 scale{1, 1, 1};
  std::string submesh;      ///< Name of the part to take; empty: all.
  bool is_centred = false;  ///< The submesh is moved to have its box about the origin.
};

/// The triangles of a COLLADA, Wavefront OBJ or STL file, in metres: COLLADA's unit is applied, its
/// up axis is not, as in Gazebo, whose models are made for that. Read once and shared for as long
/// as the file stays as it is. Thread-safe.
/// Throws DescriptionError with the cause, the file's name not in it.
std::shared_ptr<const Mesh> readMesh(const MeshRequest& request);

/// Sets the box around the vertices.
void measure(Mesh* mesh);

}  // namespace kiva
