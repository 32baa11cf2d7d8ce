// SPDX-License-Identifier: Apache-2.0
//
// Symmetric linear systems, solved directly.
#pragma once

#include <vector>

namespace kiva {

/// A square matrix, row by row.
class SquareMatrix {
 public:
  void resize(int size) {
    size_ = size;
    values_.assign(static_cast<std::size_t>(size) * size, 0);
  }
  int size() const { return size_; }
  double* operator[](int row) { return &values_[static_cast<std::size_t>(row) * size_]; }
  const double* operator[](int row) const {
    return &values_[static_cast<std::size_t>(row) * size_];
  }

 private:
  int size_ = 0;
  std::vector<double> values_;
};

/// A symmetric positive semidefinite matrix as L D Lᵀ.
class Ldl {
 public:
  /// Factorises the lower half of `a`, with each element of its diagonal increased by the share
  /// `softness`: redundant constraints then share their load evenly.
  void factorise(SquareMatrix a, double softness);
  int size() const { return l_.size(); }
  /// Turns y into L⁻¹ y.
  void solveLower(double* y) const;
  /// Turns L⁻¹ y into the solution of L D Lᵀ x = y.
  void solveUpper(double* y) const;
  double diagonal(int i) const { return d_[i]; }

 private:
  SquareMatrix l_;
  std::vector<double> d_;
};

}  // namespace kiva
