// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world_file/files/xml.h"

namespace kiva {

/// Checks for faults that the format permits and no world can have, such as a name that is taken or
/// a joint whose link is missing. Repairs or leaves out dispensable parts, with a warning; throws
/// SdfError where nothing would be left.
void checkElements(XmlElement* root, Faults* warnings);

}  // namespace kiva
