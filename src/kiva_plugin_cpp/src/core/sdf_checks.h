// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sdf/Element.hh>

namespace kiva {

/// What libsdformat lets pass, or refuses without an address, is found here before it looks.
/// Throws SdfError at the first fault at or below `element`.
void checkElements(const sdf::ElementPtr& element);

/// `child` of `element` if the document has it: libsdformat adds required ones that are missing.
sdf::ElementPtr givenChild(const sdf::ElementPtr& element, const std::string& child);

}  // namespace kiva
