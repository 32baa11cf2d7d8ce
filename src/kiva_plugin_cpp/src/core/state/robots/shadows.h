// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_set>

namespace kiva {

/// The robots that are shadows of robots elsewhere. No part of a checkpoint: the next report makes
/// a robot a shadow again.
struct Shadows {
  std::unordered_set<std::int32_t> kiva_ids;

  bool has(std::int32_t kiva_id) const { return kiva_ids.count(kiva_id) > 0; }
};

}  // namespace kiva
