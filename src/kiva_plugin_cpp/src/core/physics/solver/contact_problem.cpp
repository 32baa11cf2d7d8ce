// SPDX-License-Identifier: Apache-2.0
#include "core/physics/solver/contact_problem.h"

#include <algorithm>
#include <cmath>

#include "core/physics/solver/coulomb.h"

namespace kiva {
namespace {

// Added to the diagonal, like a softness of the ground: contacts share a load evenly that could
// rest on fewer.
constexpr double kSoftness = 1e-9;
constexpr double kHolds = 1e-12;    // [m/s]
constexpr double kSettled = 1e-10;  // [m/s], largest change in the last sweep
constexpr int kMaxSweeps = 100;
constexpr int kMaxPivots = 4;

}  // namespace

void ContactProblem::add(double friction) {
  first_[contacts_] = rows_;
  friction_[contacts_++] = friction;
  rows_ += friction > 0 ? 3 : 1;
}

void ContactProblem::solve() {
  for (int i = 0; i < rows_; ++i) a[i][i] *= 1 + kSoftness;
  if (!solveHolding()) iterate();
}

double ContactProblem::residual(int row) const {
  double sum = b[row];
  for (int j = 0; j < rows_; ++j) sum += a[row][j] * x[j];
  return sum;
}

bool ContactProblem::isWithinFriction(int c) const {
  const double limit = friction_[c] * x[first_[c]];
  const double along = x[first_[c] + 1], across = x[first_[c] + 2];
  return along * along + across * across <= limit * limit;
}

/// Assumes that contacts hold which would sink in otherwise, then determines by trial which of them
/// would pull and which others are needed. Returns whether that is the solution.
bool ContactProblem::solveHolding() {
  bool holds[kMaxContacts];
  for (int c = 0; c < contacts_; ++c) holds[c] = b[first_[c]] < 0;
  for (int round = 0; round < kMaxPivots; ++round) {
    int active[kMaxRows], count = 0;
    for (int c = 0; c < contacts_; ++c) {
      const int end = first_[c] + (hasFriction(c) ? 3 : 1);
      for (int row = first_[c]; holds[c] && row < end; ++row) active[count++] = row;
    }
    solveActive(active, count);
    bool changed = false;
    for (int c = 0; c < contacts_; ++c) {
      const bool wrong = holds[c] ? x[first_[c]] < 0 : residual(first_[c]) < -kHolds;
      if (wrong) holds[c] = !holds[c];
      changed = changed || wrong;
    }
    if (!changed) return holdWithinFriction();
  }
  return false;
}

bool ContactProblem::holdWithinFriction() const {
  for (int c = 0; c < contacts_; ++c) {
    if (hasFriction(c) && !isWithinFriction(c)) return false;
  }
  return true;
}

/// Computes x of those rows so that their a x + b = 0, with a = L D L^T; x of all others is 0.
void ContactProblem::solveActive(const int* active, int count) {
  double l[kMaxRows][kMaxRows], d[kMaxRows], y[kMaxRows];
  for (int i = 0; i < count; ++i) {
    y[i] = -b[active[i]];
    d[i] = a[active[i]][active[i]];
    for (int j = 0; j < i; ++j) {
      double sum = a[active[i]][active[j]];
      for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = sum;  // row of L D, until it is divided below
    }
    for (int j = 0; j < i; ++j) {
      const double scaled = l[i][j] / d[j];
      d[i] -= l[i][j] * scaled;
      y[i] -= scaled * y[j];
      l[i][j] = scaled;
    }
  }
  x.fill(0);
  for (int i = count - 1; i >= 0; --i) {
    double sum = y[i] / d[i];
    for (int k = i + 1; k < count; ++k) sum -= l[k][i] * x[active[k]];
    x[active[i]] = sum;
  }
}

void ContactProblem::iterate() {
  for (int sweeps = 0; sweeps < kMaxSweeps && sweep() > kSettled; ++sweeps) {
  }
}

/// Returns the largest change of a velocity.
double ContactProblem::sweep() {
  double change = 0;
  for (int c = 0; c < contacts_; ++c) {
    const int n = first_[c];
    const double before = x[n];
    x[n] = std::max(0.0, x[n] - residual(n) / a[n][n]);
    change = std::max(change, std::abs(x[n] - before) * a[n][n]);
    if (hasFriction(c)) change = std::max(change, relaxFriction(c));
  }
  return change;
}

/// Solves both directions along the ground together, on Coulomb's circle.
double ContactProblem::relaxFriction(int c) {
  const int row = first_[c] + 1;
  const double before[2] = {x[row], x[row + 1]};
  const double slip[2] = {
      residual(row) - a[row][row] * before[0] - a[row][row + 1] * before[1],
      residual(row + 1) - a[row + 1][row] * before[0] - a[row + 1][row + 1] * before[1]};
  solveCoulomb(a[row][row], a[row][row + 1], a[row + 1][row + 1], slip, friction_[c] * x[first_[c]],
               &x[row]);
  double change = 0;
  for (int i = 0; i < 2; ++i) {
    change = std::max(change, std::abs(x[row + i] - before[i]) * a[row + i][row + i]);
  }
  return change;
}

}  // namespace kiva
