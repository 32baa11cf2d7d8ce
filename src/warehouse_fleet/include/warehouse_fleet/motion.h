// SPDX-License-Identifier: Apache-2.0
//
// The positions of cells in the world, and the motion of robots between them.
#pragma once

#include "warehouse_fleet/floor.h"

namespace fleet {

/// The grid in world, and the limits of robots.
struct Motion {
  double origin_x = 0, origin_y = 0;  ///< centre of cell 0 in world [m]
  double spacing = 1;                 ///< edge of a cell [m]
  double speed = 1.5;                 ///< top speed [m/s]
  double acceleration = 1;            ///< acceleration and deceleration [m/s²]
  double quarter = 0.625;             ///< time of a quarter turn [s]
  double latency = 0.25;              ///< time from a report until its effect reaches the robot [s]

  double tick() const { return spacing / speed; }
};

/// Returns the time of a run from rest to rest [s].
double runTime(double metres, const Motion& motion);

/// Returns the time that a robot accelerating from `speed` [m/s] takes for `metres` [s]; sets
/// `speed` to its speed then.
double timeUntil(double metres, const Motion& motion, double& speed);

/// The centres of a floor's cells in the world.
class GridFrame {
 public:
  GridFrame(const Floor& floor, const Motion& motion) : floor_(floor), motion_(motion) {}

  /// Returns the cell that contains a point in world [m]; kNowhere beyond the floor.
  Cell cellAt(double x, double y) const;
  double xOf(Cell cell) const { return motion_.origin_x + floor_.x(cell) * motion_.spacing; }
  double yOf(Cell cell) const { return motion_.origin_y + floor_.y(cell) * motion_.spacing; }
  /// Returns the heading from a cell to its neighbour.
  int headingTo(Cell from, Cell to) const;

 private:
  const Floor& floor_;
  const Motion motion_;
};

}  // namespace fleet
