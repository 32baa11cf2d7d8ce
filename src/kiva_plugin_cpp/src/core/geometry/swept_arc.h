// SPDX-License-Identifier: Apache-2.0
//
// The area that a rectangle sweeps along an arc.
#pragma once

namespace kiva {

/// A rectangle that moves forwards along an arc. Its middle is on the arc, its length along it.
struct SweptArc {
  double curvature = 0;    ///< To the left [1/m].
  double half_length = 0;  ///< [m]
  double half_width = 0;   ///< [m]
};

/// Returns the way along the arc [m] after which the rectangle meets a point that is `x` ahead and
/// `y` to the left of its middle [m]; +inf if it passes, or if the point lies behind its front.
/// Arcs tighter than half the rectangle's width count as that tight.
double wayToPoint(const SweptArc& arc, double x, double y);

}  // namespace kiva
