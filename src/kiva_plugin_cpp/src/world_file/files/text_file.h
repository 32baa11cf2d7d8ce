// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace kiva {

/// The text of a file. Throws DescriptionError, also if it has more bytes than `most`.
std::string readText(const std::string& path, std::size_t most);

}  // namespace kiva
