// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kiva_ros {

/// Unregisters all topics of this node from the master in one call. roscpp would use a call for
/// each, which takes seconds with the topics of a thousand robots. Nothing may be published
/// afterwards.
void unadvertiseTopics();

}  // namespace kiva_ros
