// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace kiva {

constexpr std::size_t kMostTriangles = 1'000'000;

/// Checks a mesh file before Assimp reads it. Throws DescriptionError if Assimp would need too much
/// memory, about a kilobyte a triangle, or too much stack. `ending` is in lower case.
void checkMeshFile(const std::string& file, const std::string& ending);

/// Throws DescriptionError for more than kMostTriangles.
void checkTriangles(std::size_t count);

}  // namespace kiva
