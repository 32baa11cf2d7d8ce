// SPDX-License-Identifier: Apache-2.0
//
// Islands with joints: robots with wheels, casters, arms.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <vector>

#include "core/physics/solver/ldl.h"

namespace kiva {

/// Finds the impulses of an island's joints and contacts. To go through them in turn, as Bullet
/// does, takes thousands of rounds where light wheels bear a heavy chassis: until then it creeps.
/// So what joints hold is eliminated directly (the Schur complement; Baraff 1996), and contacts,
/// motors and limits are solved against what is left to move.
class ArticulatedSolver {
 public:
  /// Bullet's rows, set up for a step; a contact has two of friction.
  struct Island {
    btAlignedObjectArray<btSolverBody>& bodies;
    btConstraintArray& joints;
    btConstraintArray& contacts;
    btConstraintArray& frictions;
  };

  /// Sets the rows' impulses and what they change of velocities. Returns whether it did: not if
  /// there are too many rows for a direct solution.
  bool solve(const Island& island);

 private:
  /// A row that may give way: of a contact, of friction, of a motor, of a limit.
  struct Yielding {
    btSolverConstraint* row;
    double least, most;   ///< Bounds of its impulse, without friction's [N s, Nm s].
    int normal = -1;      ///< Of the first row of friction: its contact's.
    double friction = 0;  ///< Its Coulomb coefficient.
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
  std::vector<btSolverConstraint*> holding_;  ///< Rows of joints, which never give way.
  std::vector<Yielding> yielding_;
  std::vector<Kind> kinds_;
  Ldl joints_;
  SquareMatrix a_;             ///< What an impulse of a yielding row changes of another's velocity.
  std::vector<double> b_, x_;  ///< Velocity that is missing; impulses to add.
  std::vector<double> missing_;               ///< Of holding rows, multiplied by L⁻¹.
  std::vector<std::vector<double>> through_;  ///< Of each yielding row: L⁻¹ of its couplings.
  std::vector<Hold> hold_;
};

}  // namespace kiva
