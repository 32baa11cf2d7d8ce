// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kiva {

/// The friction impulse x at one contact that ends its slip a x + b along both directions of the
/// surface or, where that takes more than `limit`, one of that size against the slip that is left:
/// Coulomb's law with its principle of largest dissipation. `a` is symmetric and positive definite.
void solveCoulomb(double a00, double a01, double a11, const double b[2], double limit, double x[2]);

}  // namespace kiva
