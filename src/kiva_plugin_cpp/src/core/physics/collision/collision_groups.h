// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kiva {

/// Collision filter groups of bodies. Bodies of one model touch each other only if one of them also
/// is in `kSelfCollidingGroup`.
enum CollisionGroup : int {
  kFloorGroup = 1,
  kStaticGroup = 2,
  kDynamicGroup = 4,
  kRobotGroup = 8,
  kSelfCollidingGroup = 16
};

}  // namespace kiva
