// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world_file/files/xml.h"

namespace kiva {

/// Converts an `<sdf>` of any version to SDF 1.9, as far as it is read here. Throws SdfError if
/// there is no version, or an unknown one.
void convert(XmlElement* sdf);

}  // namespace kiva
