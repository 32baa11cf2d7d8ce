// SPDX-License-Identifier: Apache-2.0
//
// Reads `<collision>` and `<visual>`.
#pragma once

#include <optional>
#include <string>

#include "world_file/files/xml.h"

namespace kiva {

/// Where a document comes from.
struct Origin {
  /// What errors call the document: its path, if it is a file; empty for one without a name.
  std::string where;
  const ModelPaths& model_paths;
};

/// A mesh that is touched is read, one that is only seen is named.
enum class MeshUse { kTouched, kSeen };

/// The shape in the `<geometry>` of a collision or a visual; nothing for `<empty>`.
/// Throws SdfError at a mesh that can't be had, at a size that is not positive, and at a kind we
/// can't build.
std::optional<Shape> readShape(const XmlElement& owner, const Origin& origin, MeshUse use);

/// Reads friction and restitution of a `<collision>`.
void readSurface(const XmlElement& element, Collision* collision, Faults* warnings);

/// Reads the colour of a `<visual>`.
void readMaterial(const XmlElement& element, Visual* visual, Faults* warnings);

}  // namespace kiva
