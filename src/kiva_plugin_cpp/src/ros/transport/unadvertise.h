// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kiva_ros {

/// Takes all topics of this node off the master in one call. roscpp would ask for each by itself,
/// which takes seconds with those of a thousand robots. Nothing may be published afterwards.
void unadvertiseTopics();

}  // namespace kiva_ros
