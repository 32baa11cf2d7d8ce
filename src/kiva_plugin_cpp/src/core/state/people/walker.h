// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kiva_plugin_cpp/fleet.h"
#include "kiva_plugin_cpp/people.h"

namespace kiva {

/// A person, and how far they have come.
struct Walker {
  int model = -1;              ///< Index in the world's models: it stands where they do.
  double radius = 0.25;        ///< Radius of the cylinder that holds them [m],
  double bottom = 0, top = 0;  ///< and its ends above their origin [m].
  std::optional<Walk> script;  ///< An actor's walk, which a reset restarts.
  Walk walk;                   ///< What they are at.
  std::size_t next = 0;        ///< The waypoint that they go to; as many as there are: they stay.
  double pause = 0;            ///< Left where they are [s].
  std::vector<PathPoint> detour;  ///< Around what is in the way, the next one last.
  double vx = 0, vy = 0;          ///< [m/s]
  bool is_free = true;            ///< Nothing was in the way when they looked last;
  std::uint64_t look_at = 0;      ///< the step, of all, at which they look again.
  double held_up = 0;             ///< Since when something is in the way [s],
  double patience = 0;            ///< and how long that may be before they look for a way around.

  bool walks() const { return next < walk.waypoints.size(); }
  /// Returns where they go straight to, if they walk.
  PathPoint target() const {
    if (!detour.empty()) return detour.back();
    return {walk.waypoints[next].x, walk.waypoints[next].y};
  }
};

}  // namespace kiva
