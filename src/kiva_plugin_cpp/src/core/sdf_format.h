// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sdf/SDFImpl.hh>
#include <string>

namespace kiva {

/// An empty document, knowing what SDF allows in it.
sdf::SDFPtr emptyDocument();

/// What a value at `/sdf/model[@name="m"]/pose` looks like, for a person; empty if unknown.
std::string expectedValue(const std::string& xml_path);

}  // namespace kiva
