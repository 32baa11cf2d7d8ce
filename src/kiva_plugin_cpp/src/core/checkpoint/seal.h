// SPDX-License-Identifier: Apache-2.0
//
// What is around the content of a checkpoint: its format, its size and its hash.
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
/// Returns what is under the seal. Throws ArchiveError if it is broken.
Content opened(const std::string& bytes);

}  // namespace kiva
