// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kiva_ros {

/// Lets a thousand clients, or one with a thousand topics, connect at once. roscpp lets five wait
/// at its server; who finds no room tries again after 1 s, then 3 s, up to a minute. After
/// ros::start().
void raiseListenBacklog();

}  // namespace kiva_ros
