// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <btBulletDynamicsCommon.h>

namespace kiva {

/// An island as Bullet passes it to its solver: bodies, contacts and joints that may act on each
/// other.
struct ContactIsland {
  btCollisionObject** bodies = nullptr;
  int body_count = 0;
  btPersistentManifold** manifolds = nullptr;
  int manifold_count = 0;
  btTypedConstraint** joints = nullptr;
  int joint_count = 0;
};

/// Returns whether its bodies only slide on the floor and push each other sideways.
bool isPlanar(const ContactIsland& island);

/// Solves such an island by the laws of Bullet's solver, in the same order, in the three degrees of
/// freedom of its bodies. Sets velocities, and impulses of contacts and feet.
void solvePlanar(const ContactIsland& island, const btContactSolverInfo& info);

}  // namespace kiva
