// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/description.h"
#include "kiva_plugin_cpp/message_enums.h"

namespace kiva {

/// What a client may ask of a robot.
struct Command {
  enum class Kind : std::uint8_t {
    kMoveTo,
    kMoveX,
    kMoveY,
    kRotate,
    kLift,
    kCancel,  ///< End the command at the next grid point; a lift is completed first.
    kStop,    ///< Stand at once with wheels and lift held; kiva_id 0: every robot.
    kGoOn,    ///< Resume the command that kStop interrupted; kiva_id 0: every robot.
    kFollow   ///< Stands for a FollowPath among the commands; not to be posted.
  };
  Kind kind = Kind::kMoveTo;
  std::int32_t kiva_id = 0;
  double x = 0;               ///< MoveTo: goal in world [m]. MoveX: signed distance [m].
  double y = 0;               ///< MoveTo: goal in world [m]. MoveY: signed distance [m].
  int direction = 0;          ///< Rotate: +1 counterclockwise, -1 clockwise.
  int lift = 0;               ///< Lift: 1 carry, 0 drop.
  std::int32_t shelf_id = 0;  ///< Lift: number of the storage unit. Drop: 0 is any unit.
};

/// A path. The robot drives as far as the path is released, and stops only to turn. A new `path_id`
/// is a command like any other. The `path_id` of the path under way changes that path: points from
/// `first` on are replaced, but not released ones. Without points here none are replaced.
/// `released` may shrink as far as the robot can still stop.
struct FollowPath {
  std::int32_t kiva_id = 0;
  std::uint32_t path_id = 0;   ///< The sender's choice, not 0.
  std::uint32_t first = 0;     ///< Number of the path's point at x[0], y[0]; 0 in a new path.
  std::vector<double> x, y;    ///< Grid points in world [m]; neighbours differ along one axis.
                               ///< Point 0 is where the robot stands.
  std::uint32_t released = 0;  ///< Count of points of the whole path that are released, at least 1.
  /// Highest speed on the way to each of these points from the one before [m/s]: above 0, +inf = as
  /// fast as the robot is. Empty: known points keep theirs, and new ones have no limit.
  std::vector<double> max_speed;
  std::string fault;  ///< If not empty, the path is refused for this reason.
};

/// How two bodies met.
struct Impact {
  Vector3 point;       ///< Position in world [m].
  Vector3 normal;      ///< Unit vector in world, from `other` towards `model`.
  double speed = 0;    ///< Speed of approach along the normal [m/s].
  double impulse = 0;  ///< Impulse along the normal until the approach ends [Ns].
};

/// Something that happened.
struct Event {
  using Kind = EventKind;
  static constexpr int kKinds = static_cast<int>(Kind::kPickedUp) + 1;
  double time = 0;  ///< Simulated [s].
  Kind kind = Kind::kAccepted;
  std::string model;
  std::string other;
  std::string text;           ///< Text for a person.
  std::uint32_t command = 0;  ///< Number of its command, counted from 1; 0 = none.
  Impact impact{};            ///< The impact of a collision.
};

}  // namespace kiva
