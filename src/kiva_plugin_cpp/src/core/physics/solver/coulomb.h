// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kiva {

/// Computes the friction impulse x at one contact. It ends the slip a x + b along both directions
/// of the surface; if that takes more than `limit`, it has that size and opposes the remaining
/// slip, by Coulomb's law with the principle of maximum dissipation. `a` is symmetric and positive
/// definite.
void solveCoulomb(double a00, double a01, double a11, const double b[2], double limit, double x[2]);

}  // namespace kiva
