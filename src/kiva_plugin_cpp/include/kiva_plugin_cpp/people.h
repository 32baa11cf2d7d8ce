// SPDX-License-Identifier: Apache-2.0
//
// People that walk on the floor, and zones that stop robots while a person is inside.
#pragma once

#include <string>
#include <vector>

namespace kiva {

/// Walking speed of people by ISO 13855, the highest that is allowed here [m/s].
constexpr double kMostWalkingSpeed = 1.6;

/// A place on a person's way.
struct Waypoint {
  double x = 0, y = 0;  ///< Position in world [m].
  double speed = 1.2;   ///< Walking speed towards it [m/s]; above 0, up to kMostWalkingSpeed.
  double pause = 0;     ///< Duration of the stay there [s].
};

/// The walk of a person: straight from each waypoint to the next.
struct Walk {
  std::vector<Waypoint> waypoints;  ///< Empty: the person stays.
  bool loops = false;               ///< Whether the first waypoint follows the last.
};

/// A person now, in world.
struct Person {
  std::string name;
  double x = 0, y = 0, yaw = 0;     ///< [m, rad]
  double vx = 0, vy = 0;            ///< [m/s]
  double ahead_x = 0, ahead_y = 0;  ///< The place straight ahead after kForesight [m]; of a person
                                    ///< that waits, the place after walking on.
};

/// Time by which Person::ahead_x looks ahead [s].
constexpr double kForesight = 3;

/// A rectangle along the axes of `world` [m]: while a person is inside, all robots inside stand.
struct LightCurtain {
  std::string name;
  double min_x = 0, max_x = 0, min_y = 0, max_y = 0;
};

}  // namespace kiva
