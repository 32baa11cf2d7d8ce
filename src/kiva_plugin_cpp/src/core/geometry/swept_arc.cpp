// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/swept_arc.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/infinity.h"

namespace kiva {
namespace {

constexpr double kStraight = 1e-4;  // [1/m]
constexpr double kInFront = 0.05;   // [m] behind its front in which a point may still be met

}  // namespace

double wayToPoint(const SweptArc& arc, double x, double y) {
  const double length = arc.half_length, width = arc.half_width;
  if (x < length - kInFront) return kInfinity;
  const double curvature = std::min(std::abs(arc.curvature), 1 / width);
  if (curvature < kStraight) return std::abs(y) < width ? std::max(0.0, x - length) : kInfinity;
  // Around the arc's centre, to the left: the point's radius and angle, and the angle up to which
  // the rectangle reaches at that radius, with its front or with the side towards the centre.
  const double radius = 1 / curvature;
  const double aside = radius - (arc.curvature < 0 ? -y : y);
  const double away = std::hypot(x, aside);
  const double inner = radius - width;
  if (away <= inner || away >= std::hypot(length, radius + width)) return kInfinity;
  const double front = std::sqrt(std::max(0.0, away * away - length * length));
  const bool meets_front = away > length && front >= inner;
  const double reach = meets_front ? std::atan2(length, front)
                                   : std::atan2(std::sqrt(away * away - inner * inner), inner);
  return std::max(0.0, std::atan2(x, aside) - reach) * radius;
}

}  // namespace kiva
