// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kiva {

/// Collision filter groups: which bodies touch which others. Bodies of one model touch each other
/// only where one of them is of `kSelfCollidingGroup` too.
enum CollisionGroup : int {
  kFloorGroup = 1,
  kStaticGroup = 2,
  kDynamicGroup = 4,
  kRobotGroup = 8,
  kSelfCollidingGroup = 16
};

}  // namespace kiva
