// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <btBulletDynamicsCommon.h>

namespace kiva {

/// What Bullet hands its solver: bodies, contacts and joints that may act on each other.
struct ContactIsland {
  btCollisionObject** bodies = nullptr;
  int body_count = 0;
  btPersistentManifold** manifolds = nullptr;
  int manifold_count = 0;
  btTypedConstraint** joints = nullptr;
  int joint_count = 0;
};

/// Returns whether its bodies slide on the floor, push each other sideways and do no more.
bool isPlanar(const ContactIsland& island);

/// What Bullet's solver does of such an island, by the same laws in the same order, in the three
/// degrees of freedom that its bodies have: velocities after the step, and what contacts and feet
/// did in it.
void solvePlanar(const ContactIsland& island, const btContactSolverInfo& info);

}  // namespace kiva
