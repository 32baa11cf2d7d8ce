// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "world_file/elements/format.h"
#include "world_file/files/xml.h"

namespace kiva {

/// Holds an `<sdf>` of version 1.9 to the format. Removes faulty parts, as small as possible, and
/// adds them to `left_out`; adds parts that SDF does not know, which stay, to `unknown`. Does not
/// look into includes. Throws SdfError where nothing would be left.
void validate(XmlElement* sdf, Faults* left_out, Faults* unknown);

/// Returns the first fault of a document, if there is one.
std::optional<Fault> firstFault(XmlElement* sdf);

}  // namespace kiva
