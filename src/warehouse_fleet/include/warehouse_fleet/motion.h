// SPDX-License-Identifier: Apache-2.0
//
// How cells lie in the world, and how robots drive over them.
#pragma once

#include "warehouse_fleet/floor.h"

namespace fleet {

/// How cells lie in the world, and what robots can do.
struct Motion {
  double origin_x = 0, origin_y = 0;  ///< the centre of cell 0 [m]
  double spacing = 1;                 ///< of cells [m]
  double speed = 1.5;                 ///< at most [m/s]
  double acceleration = 1;            ///< and deceleration [m/s²]
  double quarter = 0.625;             ///< time of a quarter turn [s]
  double latency = 0.25;  ///< from a report to what it leads to having reached the robot [s]

  double tick() const { return spacing / speed; }
};

/// Returns how long a run from rest to rest takes [s].
double runTime(double metres, const Motion& motion);

/// Returns when a robot that accelerates from `speed` [m/s] has come so far [s]; `speed` becomes
/// what it has then.
double timeUntil(double metres, const Motion& motion, double& speed);

/// The centres of a floor's cells in the world.
class GridFrame {
 public:
  GridFrame(const Floor& floor, const Motion& motion) : floor_(floor), motion_(motion) {}

  /// Returns the cell around a place [m]; kNowhere beyond the floor.
  Cell cellAt(double x, double y) const;
  double xOf(Cell cell) const { return motion_.origin_x + floor_.x(cell) * motion_.spacing; }
  double yOf(Cell cell) const { return motion_.origin_y + floor_.y(cell) * motion_.spacing; }
  /// Returns the heading from a cell to one beside it.
  int headingTo(Cell from, Cell to) const;

 private:
  const Floor& floor_;
  const Motion motion_;
};

}  // namespace fleet
