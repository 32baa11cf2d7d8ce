// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// What a client may ask of a robot.
struct Command {
  enum class Kind : std::uint8_t { kMoveTo, kMoveX, kMoveY, kRotate, kLift };
  Kind kind = Kind::kMoveTo;
  std::int32_t kiva_id = 0;
  double x = 0;               ///< MoveTo: goal in world [m]. MoveX: signed distance [m].
  double y = 0;               ///< MoveTo: goal in world [m]. MoveY: signed distance [m].
  int direction = 0;          ///< Rotate: +1 counterclockwise, -1 clockwise.
  int lift = 0;               ///< Lift: 1 carry, 0 drop.
  std::int32_t shelf_id = 0;  ///< Lift: the storage unit's number; drop, 0: whichever it carries.
};

/// How two bodies met.
struct Impact {
  Vector3 point;       ///< In world [m].
  Vector3 normal;      ///< Unit vector in world, from `other` towards `model`.
  double speed = 0;    ///< With which they approached along the normal [m/s].
  double impulse = 0;  ///< Along the normal, until they no longer approach [Ns].
};

/// Something that happened. Values as in warehouse_msgs/Event.
struct Event {
  enum class Kind : std::uint8_t {
    kAccepted = 0,
    kRefused = 1,
    kDone = 2,
    kBlocked = 3,
    kLifted = 4,
    kDropped = 5,
    kCollision = 6,
    kSpawned = 7,
    kDeleted = 8
  };
  double time = 0;  ///< Simulated [s].
  Kind kind = Kind::kAccepted;
  std::string model;
  std::string other;
  std::string text;           ///< For a person.
  std::uint32_t command = 0;  ///< The command that it belongs to, counted from 1; 0 = none.
  Impact impact{};            ///< Of a collision.
};

}  // namespace kiva
