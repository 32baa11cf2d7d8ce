// SPDX-License-Identifier: Apache-2.0
#include "core/physics/solver/ldl.h"

#include <utility>

namespace kiva {

void Ldl::factorise(SquareMatrix a, double softness) {
  l_ = std::move(a);
  const int n = l_.size();
  d_.assign(n, 0);
  for (int i = 0; i < n; ++i) {
    double* const row = l_[i];
    const double own = row[i] * (1 + softness);
    d_[i] = own;
    for (int j = 0; j < i; ++j) {
      const double* const other = l_[j];
      for (int k = 0; k < j; ++k)
        row[j] -= row[k] * other[k];  // row of L D, until it is divided below
    }
    for (int j = 0; j < i; ++j) {
      const double scaled = row[j] / d_[j];
      d_[i] -= row[j] * scaled;
      row[j] = scaled;
    }
    if (d_[i] < own * softness / 2)
      d_[i] = own * softness;   // at least its softness, in spite of rounding
    if (d_[i] <= 0) d_[i] = 1;  // a row without mobility
  }
}

void Ldl::solveLower(double* y) const {
  for (int i = 0; i < size(); ++i) {
    const double* const row = l_[i];
    for (int k = 0; k < i; ++k) y[i] -= row[k] * y[k];
  }
}

void Ldl::solveUpper(double* y) const {
  for (int i = size() - 1; i >= 0; --i) {
    y[i] /= d_[i];
  }
  for (int i = size() - 1; i >= 0; --i) {
    const double* const row = l_[i];
    for (int k = 0; k < i; ++k) y[k] -= row[k] * y[i];
  }
}

}  // namespace kiva
