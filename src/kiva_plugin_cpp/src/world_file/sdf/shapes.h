// SPDX-License-Identifier: Apache-2.0
//
// Reads `<collision>` and `<visual>`.
#pragma once

#include <optional>
#include <string>

#include "world_file/files/xml.h"

namespace kiva {

/// The origin of a document.
struct Origin {
  /// Name of the document in errors: its path, if it is a file, or empty.
  std::string where;
  const ModelPaths& model_paths;
};

/// The treatment of meshes: those of collisions are read, those of visuals only named.
enum class MeshUse { kTouched, kSeen };

/// Returns the shape in the `<geometry>` of a collision or a visual; nothing for `<empty>`.
/// Throws SdfError at a mesh that can't be read, at a size that is not positive, and at an unknown
/// kind.
std::optional<Shape> readShape(const XmlElement& owner, const Origin& origin, MeshUse use);

/// Reads friction and restitution of a `<collision>`.
void readSurface(const XmlElement& element, Collision* collision, Faults* warnings);

/// Reads the colour of a `<visual>`.
void readMaterial(const XmlElement& element, Visual* visual, Faults* warnings);

}  // namespace kiva
