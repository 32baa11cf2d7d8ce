// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kiva_plugin_cpp/fleet.h"
#include "kiva_plugin_cpp/people.h"

namespace kiva {

/// A person and the progress of their walk.
struct Walker {
  int model = -1;                 ///< Index of their model.
  double radius = 0.25;           ///< Radius of the cylinder that holds them [m],
  double bottom = 0, top = 0;     ///< and its ends above their origin [m].
  std::optional<Walk> script;     ///< An actor's walk, which a reset restarts.
  Walk walk;                      ///< The present walk.
  std::size_t next = 0;           ///< Index of the next waypoint; their count = they stay.
  double pause = 0;               ///< Time left at the present place [s].
  std::vector<PathPoint> detour;  ///< Waypoints around an obstacle, the next one last.
  double vx = 0, vy = 0;          ///< [m/s]
  bool is_free = true;            ///< Their way was free at the last look.
  std::uint64_t look_at = 0;      ///< Total step of the next look.
  double held_up = 0;             ///< Time for which an obstacle has been in the way [s].
  double patience = 0;            ///< Wait before they look for a way around it [s].

  bool walks() const { return next < walk.waypoints.size(); }
  /// Returns the next point that they walk to.
  PathPoint target() const {
    if (!detour.empty()) return detour.back();
    return {walk.waypoints[next].x, walk.waypoints[next].y};
  }
};

}  // namespace kiva
