// SPDX-License-Identifier: Apache-2.0
#include "core/physics/solver/articulated_solver.h"

#include <algorithm>
#include <cmath>

#include "core/physics/solver/coulomb.h"

namespace kiva {
namespace {

constexpr int kMostRows = 400;          // limit of each kind: a direct solution takes cubic time
constexpr double kNoBound = 1e15;       // limits of an impulse from which on it is unlimited
constexpr double kSharing = 1e-9;       // see Ldl
constexpr double kInert = 1e-6;         // smallest share of a row's mobility that joints must leave
constexpr double kNearlyStill = 1e-12;  // [m/s, rad/s]
constexpr double kNoChange = 1e-9;      // [m/s, rad/s], largest change in the last sweep
constexpr int kMostSweeps = 100;
constexpr int kMostTrials = 8;

/// Returns the change of the velocity along `r` by an impulse of 1 along `s`.
double coupling(btAlignedObjectArray<btSolverBody>& bodies, const btSolverConstraint& r,
                const btSolverConstraint& s) {
  double sum = 0;
  const auto add = [&](int body, const btVector3& r_linear, const btVector3& r_angular,
                       const btVector3& s_linear, const btVector3& s_angular) {
    sum += (r_linear * bodies[body].internalGetInvMass()).dot(s_linear) + r_angular.dot(s_angular);
  };
  if (r.m_solverBodyIdA == s.m_solverBodyIdA) {
    add(r.m_solverBodyIdA, r.m_contactNormal1, r.m_relpos1CrossNormal, s.m_contactNormal1,
        s.m_angularComponentA);
  } else if (r.m_solverBodyIdA == s.m_solverBodyIdB) {
    add(r.m_solverBodyIdA, r.m_contactNormal1, r.m_relpos1CrossNormal, s.m_contactNormal2,
        s.m_angularComponentB);
  }
  if (r.m_solverBodyIdB == s.m_solverBodyIdB) {
    add(r.m_solverBodyIdB, r.m_contactNormal2, r.m_relpos2CrossNormal, s.m_contactNormal2,
        s.m_angularComponentB);
  } else if (r.m_solverBodyIdB == s.m_solverBodyIdA) {
    add(r.m_solverBodyIdB, r.m_contactNormal2, r.m_relpos2CrossNormal, s.m_contactNormal1,
        s.m_angularComponentA);
  }
  return sum;
}

/// Returns the change of velocity per impulse due to softness.
double softnessOf(const btSolverConstraint& row) { return row.m_cfm / row.m_jacDiagABInv; }

/// Returns the change of velocity along the row that is still missing.
double missing(btAlignedObjectArray<btSolverBody>& bodies, const btSolverConstraint& row) {
  btSolverBody &a = bodies[row.m_solverBodyIdA], &b = bodies[row.m_solverBodyIdB];
  return row.m_rhs / row.m_jacDiagABInv - softnessOf(row) * row.m_appliedImpulse -
         row.m_contactNormal1.dot(a.internalGetDeltaLinearVelocity()) -
         row.m_relpos1CrossNormal.dot(a.internalGetDeltaAngularVelocity()) -
         row.m_contactNormal2.dot(b.internalGetDeltaLinearVelocity()) -
         row.m_relpos2CrossNormal.dot(b.internalGetDeltaAngularVelocity());
}

}  // namespace

bool ArticulatedSolver::solve(const Island& island) {
  bodies_ = &island.bodies;
  if (!sortRows(island)) return false;
  eliminateJoints();
  if (!solveHolding()) iterate();
  std::vector<double> held = missing_;
  for (std::size_t i = 0; i < yielding_.size(); ++i) {
    for (std::size_t k = 0; k < held.size(); ++k) held[k] -= through_[i][k] * x_[i];
    apply(yielding_[i].row, x_[i]);
  }
  joints_.solveUpper(held.data());
  for (std::size_t k = 0; k < held.size(); ++k) apply(holding_[k], held[k]);
  return true;
}

bool ArticulatedSolver::sortRows(const Island& island) {
  holding_.clear();
  yielding_.clear();
  kinds_.clear();
  const auto add = [&](const YieldingRow& row, Kind kind) {
    yielding_.push_back(row);
    kinds_.push_back(kind);
  };
  for (int i = 0; i < island.joints.size(); ++i) {
    btSolverConstraint& row = island.joints[i];
    if (row.m_jacDiagABInv == 0) continue;
    if (row.m_lowerLimit <= -kNoBound && row.m_upperLimit >= kNoBound) {
      holding_.push_back(&row);
    } else {
      add({&row, row.m_lowerLimit, row.m_upperLimit}, Kind::kBounded);
    }
  }
  for (int i = 0; i < island.contacts.size(); ++i) {
    btSolverConstraint& row = island.contacts[i];
    if (row.m_jacDiagABInv == 0) continue;
    const int normal = static_cast<int>(yielding_.size());
    add({&row, 0, kNoBound}, Kind::kBounded);
    btSolverConstraint* const sliding = &island.frictions[row.m_frictionIndex];
    if (!(sliding->m_friction > 0)) continue;
    for (int way : {0, 1}) {
      add({sliding + way, -kNoBound, kNoBound, normal, sliding->m_friction}, Kind::kFriction);
    }
  }
  return holding_.size() <= kMostRows && yielding_.size() <= kMostRows;
}

void ArticulatedSolver::eliminateJoints() {
  const int held = static_cast<int>(holding_.size()), count = static_cast<int>(yielding_.size());
  SquareMatrix a;
  a.resize(held);
  missing_.resize(held);
  for (int i = 0; i < held; ++i) {
    for (int j = 0; j <= i; ++j) a[i][j] = coupling(*bodies_, *holding_[i], *holding_[j]);
    a[i][i] += softnessOf(*holding_[i]);
    missing_[i] = missing(*bodies_, *holding_[i]);
  }
  joints_.factorise(std::move(a), kSharing);
  joints_.solveLower(missing_.data());
  a_.resize(count);
  b_.resize(count);
  x_.assign(count, 0);
  through_.resize(count);
  std::vector<double> scaled(held);
  for (int i = 0; i < count; ++i) {
    const btSolverConstraint& row = *yielding_[i].row;
    std::vector<double>& through = through_[i];
    through.resize(held);
    for (int k = 0; k < held; ++k) through[k] = coupling(*bodies_, *holding_[k], row);
    joints_.solveLower(through.data());
    b_[i] = missing(*bodies_, row);
    for (int k = 0; k < held; ++k) {
      scaled[k] = through[k] / joints_.diagonal(k);
      b_[i] -= scaled[k] * missing_[k];
    }
    for (int j = 0; j <= i; ++j) {
      const double bare = coupling(*bodies_, row, *yielding_[j].row);
      double sum = i == j ? bare + softnessOf(row) : bare;
      for (int k = 0; k < held; ++k) sum -= scaled[k] * through_[j][k];
      if (i == j && sum < kInert * bare) sum = 0;
      a_[i][j] = a_[j][i] = sum;
    }
  }
}

double ArticulatedSolver::residual(int i) const {
  const double* const row = a_[i];
  double sum = b_[i];
  for (std::size_t j = 0; j < x_.size(); ++j) sum -= row[j] * x_[j];
  return sum;
}

/// Assumes that every contact holds unless it pulls, then determines by trial which contacts open
/// and which motors are at their limits. Returns whether nothing slips in that solution.
bool ArticulatedSolver::solveHolding() {
  const int count = static_cast<int>(yielding_.size());
  hold_.assign(count, Hold::kFree);
  std::vector<int> free;
  for (int round = 0; round < kMostTrials; ++round) {
    free.clear();
    for (int i = 0; i < count; ++i) {
      const int decides = isFriction(i) ? yielding_[i].normal : i;
      if (hold_[decides] == Hold::kFree && a_[i][i] > 0) {
        free.push_back(i);
      } else {
        const double at = hold_[decides] == Hold::kAtMost ? yielding_[i].most : yielding_[i].least;
        x_[i] = (isFriction(i) || a_[i][i] <= 0 ? 0 : at) - yielding_[i].row->m_appliedImpulse;
      }
    }
    solveFree(free);
    bool changed = false;
    for (int i = 0; i < count; ++i) {
      if (isFriction(i) || a_[i][i] <= 0) continue;
      Hold now = hold_[i];
      if (now == Hold::kFree) {
        if (impulse(i) < yielding_[i].least) now = Hold::kAtLeast;
        if (impulse(i) > yielding_[i].most) now = Hold::kAtMost;
      } else if ((residual(i) > kNearlyStill) == (now == Hold::kAtLeast) &&
                 std::abs(residual(i)) > kNearlyStill) {
        now = Hold::kFree;
      }
      changed |= now != hold_[i];
      hold_[i] = now;
    }
    if (changed) continue;
    for (int i = 0; i < count; ++i) {
      if (!isFriction(i)) continue;
      const double limit = yielding_[i].friction * impulse(yielding_[i].normal);
      if (std::hypot(impulse(i), impulse(i + 1)) > limit) return false;
      ++i;
    }
    return true;
  }
  return false;
}

/// Computes x of those rows so that nothing is missing along them.
void ArticulatedSolver::solveFree(const std::vector<int>& free) {
  const int count = static_cast<int>(free.size());
  SquareMatrix a;
  a.resize(count);
  std::vector<double> y(count);
  for (int i : free) x_[i] = 0;
  for (int i = 0; i < count; ++i) {
    y[i] = residual(free[i]);
    for (int j = 0; j <= i; ++j) a[i][j] = a_[free[i]][free[j]];
  }
  Ldl ldl;
  ldl.factorise(std::move(a), kSharing);
  ldl.solveLower(y.data());
  ldl.solveUpper(y.data());
  for (int i = 0; i < count; ++i) x_[free[i]] = y[i];
}

/// Iterates by projected Gauss-Seidel (Jourdan, Alart, Jean 1998) from the present solution.
void ArticulatedSolver::iterate() {
  for (int sweeps = 0; sweeps < kMostSweeps && sweep() > kNoChange; ++sweeps) {
  }
}

/// Returns the largest change of a velocity.
double ArticulatedSolver::sweep() {
  double change = 0;
  for (int i = 0; i < static_cast<int>(yielding_.size()); ++i) {
    if (isFriction(i)) {
      change = std::max(change, relaxFriction(i++));
    } else {
      change = std::max(change, relax(i));
    }
  }
  return change;
}

double ArticulatedSolver::relax(int i) {
  if (a_[i][i] <= 0) return 0;
  const double before = x_[i], applied = yielding_[i].row->m_appliedImpulse;
  x_[i] = std::clamp(before + residual(i) / a_[i][i], yielding_[i].least - applied,
                     yielding_[i].most - applied);
  return std::abs(x_[i] - before) * a_[i][i];
}

/// Solves both directions of the surface together, on Coulomb's circle. Joints may block one of
/// them.
double ArticulatedSolver::relaxFriction(int i) {
  const double limit = yielding_[i].friction * std::max(0.0, impulse(yielding_[i].normal));
  const double a00 = a_[i][i], a01 = a_[i][i + 1], a11 = a_[i + 1][i + 1];
  double x[2] = {impulse(i), impulse(i + 1)};
  const double before[2] = {x[0], x[1]};
  if (a00 > 0 && a11 > 0) {
    const double slip[2] = {-residual(i) - a00 * x[0] - a01 * x[1],
                            -residual(i + 1) - a01 * x[0] - a11 * x[1]};
    solveCoulomb(a00 * (1 + kSharing), a01, a11 * (1 + kSharing), slip, limit, x);
  } else {
    for (int way : {0, 1}) {
      const double a = a_[i + way][i + way];
      if (a > 0) x[way] = std::clamp(x[way] + residual(i + way) / a, -limit, limit);
    }
  }
  double change = 0;
  for (int way : {0, 1}) {
    x_[i + way] += x[way] - before[way];
    change = std::max(change, std::abs(x[way] - before[way]) * a_[i + way][i + way]);
  }
  return change;
}

void ArticulatedSolver::apply(btSolverConstraint* row, double impulse) {
  btSolverBody &a = (*bodies_)[row->m_solverBodyIdA], &b = (*bodies_)[row->m_solverBodyIdB];
  a.internalApplyImpulse(row->m_contactNormal1 * a.internalGetInvMass(), row->m_angularComponentA,
                         impulse);
  b.internalApplyImpulse(row->m_contactNormal2 * b.internalGetInvMass(), row->m_angularComponentB,
                         impulse);
  row->m_appliedImpulse = row->m_appliedImpulse + impulse;
}

}  // namespace kiva
