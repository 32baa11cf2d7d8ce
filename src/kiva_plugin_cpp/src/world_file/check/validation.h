// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "world_file/elements/format.h"
#include "world_file/files/xml.h"

namespace kiva {

/// Holds an `<sdf>` of version 1.9 to the format: what is faulty in it is left out, as small a part
/// as the rest can do without, and `left_out` is told; `unknown` is told what SDF does not know,
/// which stays. Includes are not looked into. Throws SdfError where nothing would be left.
void validate(XmlElement* sdf, Faults* left_out, Faults* unknown);

/// The first fault of a document; nothing: none.
std::optional<Fault> firstFault(XmlElement* sdf);

}  // namespace kiva
