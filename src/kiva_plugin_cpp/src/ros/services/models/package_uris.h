// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kiva_ros {

/// Returns a text in which each `package://name/` of an installed package is replaced by its path;
/// URDF files name their meshes by such URIs.
std::string resolvePackageUris(const std::string& text);

}  // namespace kiva_ros
