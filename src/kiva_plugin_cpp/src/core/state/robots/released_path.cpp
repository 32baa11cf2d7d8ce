// SPDX-License-Identifier: Apache-2.0
#include "core/state/robots/released_path.h"

#include <algorithm>

namespace kiva {

bool ReleasedPath::isStraight(std::uint32_t from, std::uint32_t to, std::uint32_t number) const {
  const ReleasedPath& p = *this;
  const double dx = p[to].x - p[from].x, dy = p[to].y - p[from].y;
  const double on_x = p[number].x - p[to].x, on_y = p[number].y - p[to].y;
  return dx * on_x + dy * on_y > 0;
}

void ReleasedPath::extendRun() {
  while (end + 1 < released && (end == origin || isStraight(end - 1, end, end + 1))) ++end;
}

void ReleasedPath::forgetBefore(std::uint32_t number) {
  if (number <= first) return;
  const std::uint32_t left = std::min(number, size()) - first;
  points.erase(points.begin(), points.begin() + left);
  if (isLimited()) limits.erase(limits.begin(), limits.begin() + left);
  first = number;
}

}  // namespace kiva
