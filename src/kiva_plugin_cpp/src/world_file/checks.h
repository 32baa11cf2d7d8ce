// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sdf/Element.hh>
#include <sdf/Types.hh>

namespace kiva {

/// What libsdformat lets pass, or refuses without an address, is found here before it looks.
/// Repairs or leaves out what the rest can do without, with a warning; throws SdfError where
/// nothing would be left.
void checkElements(const sdf::ElementPtr& root, sdf::Errors* warnings);

/// `child` of `element` if the document has it: libsdformat adds required ones that are missing.
sdf::ElementPtr givenChild(const sdf::ElementPtr& element, const std::string& child);

}  // namespace kiva
