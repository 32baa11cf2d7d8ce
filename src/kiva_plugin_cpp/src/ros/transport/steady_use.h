// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

namespace kiva_ros {

/// Whether the memory in use stays the same from one look to the next.
class SteadyUse {
 public:
  /// Forgets the last look: the next one has nothing to compare with.
  void restart() { before_.reset(); }
  /// One look: whether `used` [bytes] differs from the last one by at most 1/kSteady.
  bool isSteadyAt(std::size_t used) {
    const std::optional<std::size_t> before = before_;
    before_ = used;
    if (!before) return false;
    const std::size_t change = used > *before ? used - *before : *before - used;
    return change <= used / kSteady;
  }

 private:
  static constexpr std::size_t kSteady = 100;

  std::optional<std::size_t> before_;  ///< [bytes]
};

}  // namespace kiva_ros
