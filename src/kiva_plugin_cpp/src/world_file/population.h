// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "world_file/xml_parts.h"

namespace kiva {

/// The models that a `<population>` stands for, as SDF on one line: `name_clone_0`, `name_clone_1`,
/// and so on, as Gazebo calls them. Random places are the same each time.
/// Throws DescriptionError with the cause.
std::string populate(const XmlPart& population);

}  // namespace kiva
