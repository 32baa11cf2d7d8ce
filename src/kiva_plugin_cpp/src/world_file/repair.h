// SPDX-License-Identifier: Apache-2.0
//
// Leaves out faulty parts alone, where libsdformat refuses the whole text.
#pragma once

#include <functional>
#include <optional>
#include <sdf/Error.hh>
#include <sdf/Types.hh>

#include "world_file/xml.h"

namespace kiva {

/// Returns libsdformat's error for a document; nothing if it is accepted.
using FaultOf = std::function<std::optional<sdf::Error>(const XmlDocument& document)>;

/// Takes the smallest part out of `document` that `fault` is about and that the rest can do
/// without, with a warning. Where the fault has no address it is found by leaving parts out in
/// turn. Returns false if the fault is in none.
bool leaveOut(const sdf::Error& fault, const FaultOf& fault_of, XmlDocument* document,
              sdf::Errors* warnings);

}  // namespace kiva
