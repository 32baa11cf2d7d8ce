// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world_file/files/xml.h"

namespace kiva {

/// Makes SDF 1.9 of an `<sdf>` of any version, as far as parts of it are read here. Throws SdfError
/// if there is no version, or an unknown one.
void convert(XmlElement* sdf);

}  // namespace kiva
