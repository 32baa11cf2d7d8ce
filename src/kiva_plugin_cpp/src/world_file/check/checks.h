// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world_file/files/xml.h"

namespace kiva {

/// Checks for faults that the format allows and no world can have: names that are taken, joints of
/// missing links. Repairs or leaves out what the rest can do without, with a warning; throws
/// SdfError where nothing would be left.
void checkElements(XmlElement* root, Faults* warnings);

}  // namespace kiva
