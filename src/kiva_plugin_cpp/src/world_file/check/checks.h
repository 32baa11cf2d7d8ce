// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world_file/files/xml.h"

namespace kiva {

/// What the format allows and no world can be made of: names that are taken, joints of links that
/// are not there. Repairs or leaves out what the rest can do without, with a warning; throws
/// SdfError where nothing would be left.
void checkElements(XmlElement* root, Faults* warnings);

}  // namespace kiva
