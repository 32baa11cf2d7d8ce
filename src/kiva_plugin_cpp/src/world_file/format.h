// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <sdf/SDFImpl.hh>
#include <string>
#include <vector>

namespace kiva {

/// An empty document, knowing what SDF allows in it; of its large optional parts, sensors for one,
/// only those whose names occur in `text`. For libsdformat copies its description of an element,
/// with all that might be inside, for each that it reads: most of its time goes there.
sdf::SDFPtr emptyDocument(const std::string& text);

/// A part of an address like `/sdf/model[@name="m"]/pose`.
struct PathStep {
  std::string element;
  std::optional<std::string> name;
};
std::vector<PathStep> pathSteps(const std::string& xml_path);

/// What a value at `/sdf/model[@name="m"]/pose` looks like, for a person; empty if unknown.
std::string expectedValue(const std::string& xml_path);

}  // namespace kiva
