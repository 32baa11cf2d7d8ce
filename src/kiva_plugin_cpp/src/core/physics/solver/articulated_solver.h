// SPDX-License-Identifier: Apache-2.0
//
// The solver of islands with joints: robots with wheels, casters, arms.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <vector>

#include "core/physics/solver/ldl.h"

namespace kiva {

/// Computes the impulses of an island's joints and contacts. Iterating over them, as Bullet does,
/// takes thousands of rounds where light wheels bear a heavy chassis, which creeps until then. So
/// the rows of joints are eliminated directly (the Schur complement; Baraff 1996), and contacts,
/// motors and limits are solved for the remaining mobility.
class ArticulatedSolver {
 public:
  /// Bullet's rows, set up for a step; a contact has two of friction.
  struct Island {
    btAlignedObjectArray<btSolverBody>& bodies;
    btConstraintArray& joints;
    btConstraintArray& contacts;
    btConstraintArray& frictions;
  };

  /// Sets the rows' impulses and applies them to the velocities. Returns false if there are too
  /// many rows for a direct solution.
  bool solve(const Island& island);

 private:
  /// A row that may yield: a contact, friction, a motor or a limit.
  struct YieldingRow {
    btSolverConstraint* row;
    double least, most;   ///< Limits of its impulse, except friction's [N s, Nm s].
    int normal = -1;      ///< Row of the contact, in the first row of its friction.
    double friction = 0;  ///< Coulomb coefficient of that friction.
  };
  enum class Hold : char { kFree, kAtLeast, kAtMost };

  bool sortRows(const Island& island);
  void eliminateJoints();
  bool solveHolding();
  void solveFree(const std::vector<int>& free);
  void iterate();
  double sweep();
  double relax(int i);
  double relaxFriction(int i);
  bool isFriction(int i) const { return kinds_[i] == Kind::kFriction; }
  double residual(int i) const;
  double impulse(int i) const { return yielding_[i].row->m_appliedImpulse + x_[i]; }
  void apply(btSolverConstraint* row, double impulse);

  enum class Kind : char { kBounded, kFriction };

  btAlignedObjectArray<btSolverBody>* bodies_ = nullptr;
  std::vector<btSolverConstraint*> holding_;  ///< Rows of joints, which never yield.
  std::vector<YieldingRow> yielding_;
  std::vector<Kind> kinds_;
  Ldl joints_;
  SquareMatrix a_;  ///< Change of a yielding row's velocity by an impulse of another one.
  std::vector<double> b_, x_;    ///< Missing velocities, and impulses to add.
  std::vector<double> missing_;  ///< Missing velocities of holding rows, multiplied by L⁻¹.
  std::vector<std::vector<double>> through_;  ///< L⁻¹ of the couplings of each yielding row.
  std::vector<Hold> hold_;
};

}  // namespace kiva
