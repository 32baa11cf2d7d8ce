// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace kiva {

/// Returns the text of a file. Throws DescriptionError, also if it has more than `most` bytes.
std::string readText(const std::string& path, std::size_t most);

}  // namespace kiva
