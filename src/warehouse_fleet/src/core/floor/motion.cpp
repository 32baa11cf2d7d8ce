// SPDX-License-Identifier: Apache-2.0
#include "warehouse_fleet/motion.h"

#include <algorithm>
#include <cmath>

namespace fleet {

double runTime(double metres, const Motion& motion) {
  const double ramps = motion.speed * motion.speed / motion.acceleration;
  if (metres >= ramps) return metres / motion.speed + motion.speed / motion.acceleration;
  return 2 * std::sqrt(metres / motion.acceleration);
}

double timeUntil(double metres, const Motion& motion, double& speed) {
  const double begin = speed;
  const double end = std::sqrt(begin * begin + 2 * motion.acceleration * metres);
  if (end <= motion.speed) {
    speed = end;
    return (end - begin) / motion.acceleration;
  }
  speed = motion.speed;
  const double ramp = (speed * speed - begin * begin) / (2 * motion.acceleration);
  return std::max(0.0, speed - begin) / motion.acceleration + (metres - ramp) / speed;
}

Cell GridFrame::cellAt(double x, double y) const {
  const double column = std::round((x - motion_.origin_x) / motion_.spacing);
  const double row = std::round((y - motion_.origin_y) / motion_.spacing);
  const bool is_inside =
      column >= 0 && column < floor_.width() && row >= 0 && row < floor_.height();
  return is_inside ? static_cast<Cell>(row) * floor_.width() + static_cast<Cell>(column) : kNowhere;
}

int GridFrame::headingTo(Cell from, Cell to) const {
  const int step = to - from;
  if (step == floor_.width()) return 1;
  if (step == -floor_.width()) return 3;
  return step > 0 ? 0 : 2;
}

}  // namespace fleet
