// SPDX-License-Identifier: Apache-2.0
//
// The envelope of a checkpoint's content: format, size and hash.
#pragma once

#include <cstdint>
#include <string>

#include "core/checkpoint/archive.h"

namespace kiva {

struct Content {
  Reader reader;
  std::uint64_t hash;
};

std::string sealed(const std::string& content);
/// Returns the content of an envelope. Throws ArchiveError if it is damaged.
Content opened(const std::string& bytes);

}  // namespace kiva
