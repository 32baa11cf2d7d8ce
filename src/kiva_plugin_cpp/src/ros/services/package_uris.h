// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kiva_ros {

/// A text with every `package://name/` of a package that is found written as its path; URDF files
/// name their meshes so.
std::string resolvePackageUris(const std::string& text);

}  // namespace kiva_ros
