// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <sdf/SDFImpl.hh>
#include <string>
#include <vector>

namespace kiva {

/// An empty document, knowing what SDF allows in it.
sdf::SDFPtr emptyDocument();

/// A part of an address like `/sdf/model[@name="m"]/pose`.
struct PathStep {
  std::string element;
  std::optional<std::string> name;
};
std::vector<PathStep> pathSteps(const std::string& xml_path);

/// What a value at `/sdf/model[@name="m"]/pose` looks like, for a person; empty if unknown.
std::string expectedValue(const std::string& xml_path);

}  // namespace kiva
