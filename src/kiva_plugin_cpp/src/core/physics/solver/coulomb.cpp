// SPDX-License-Identifier: Apache-2.0
#include "core/physics/solver/coulomb.h"

#include <cmath>

namespace kiva {
namespace {

constexpr int kMaxRounds = 30;
constexpr double kExact = 1e-13;  // relative to the limit

/// Computes x = -(a + shift)^-1 b.
void solveShifted(double a00, double a01, double a11, double shift, const double b[2],
                  double x[2]) {
  const double d0 = a00 + shift, d1 = a11 + shift, determinant = d0 * d1 - a01 * a01;
  x[0] = (-d1 * b[0] + a01 * b[1]) / determinant;
  x[1] = (a01 * b[0] - d0 * b[1]) / determinant;
}

}  // namespace

void solveCoulomb(double a00, double a01, double a11, const double b[2], double limit,
                  double x[2]) {
  if (limit <= 0) {
    x[0] = x[1] = 0;
    return;
  }
  solveShifted(a00, a01, a11, 0, b, x);
  // On the circle slip and friction are opposite: a x + b = -shift x. Newton's method on 1 /
  // |x(shift)|, which is nearly linear (Moré and Sorensen 1983), computes the shift.
  double shift = 0;
  for (int round = 0; round < kMaxRounds; ++round) {
    const double size = std::sqrt(x[0] * x[0] + x[1] * x[1]);
    if (size <= limit * (1 + kExact)) return;
    const double minus_x[2] = {-x[0], -x[1]};
    double solved[2];
    solveShifted(a00, a01, a11, shift, minus_x, solved);
    shift += (size / limit - 1) * size * size / (x[0] * solved[0] + x[1] * solved[1]);
    solveShifted(a00, a01, a11, shift, b, x);
  }
}

}  // namespace kiva
