// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace kiva {

constexpr std::size_t kMostTriangles = 1'000'000;

/// Throws DescriptionError at a mesh file that would take Assimp too much memory, a kilobyte for
/// each triangle, or too much stack: before it is given to Assimp. `ending` is in lower case.
void checkMeshFile(const std::string& file, const std::string& ending);

/// Throws DescriptionError for more than kMostTriangles.
void checkTriangles(std::size_t count);

}  // namespace kiva
