// SPDX-License-Identifier: Apache-2.0
//
// Bullet without memory of the past. Bullet's results depend on the history of the lists that it
// iterates over: the solver takes contacts in the order of their creation, and bodies form an
// island when their enlarged boxes overlap. Here a step depends on bodies, contacts and joints
// alone, so that a world rebuilt from these continues as the original, bit by bit.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <vector>

#include "core/physics/solver/articulated_solver.h"

namespace kiva {

/// Marks every manifold with its parts of both bodies, in its companion ids.
class OrderedDispatcher : public btCollisionDispatcher {
 public:
  explicit OrderedDispatcher(btCollisionConfiguration* configuration);

  btPersistentManifold* getNewManifold(const btCollisionObject* a,
                                       const btCollisionObject* b) override;
  bool needsCollision(const btCollisionObject* a, const btCollisionObject* b) override;
  /// Returns the manifolds with contacts, ordered by the arrival of their bodies, then by parts.
  std::vector<btPersistentManifold*> manifolds() const;
  /// Returns an empty manifold for every two parts near each other, also of sleeping bodies.
  std::vector<btPersistentManifold*> makeManifolds(btOverlappingPairCache* pairs,
                                                   const btDispatcherInfo& info);

 private:
  bool minds_sleepers_ = false;  ///< Whether sleeping bodies are tested, too.
};

/// Leaves out pairs of bodies of one model, unless the model says that its links touch each other.
/// Wheels turn within the hull of a chassis, and the joint between them is no contact.
class OwnPartsFilter : public btOverlapFilterCallback {
 public:
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override;
};

/// Solves an island's contacts and joints in the order of their bodies. Expects split impulses:
/// overlapping bodies are moved apart without a change of their velocities.
class OrderedSolver : public btSequentialImpulseConstraintSolver {
 public:
  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** joints, int joint_count,
                      const btContactSolverInfo& info, btIDebugDraw* draw,
                      btDispatcher* dispatcher) override;

 protected:
  /// Limits the speed at which overlapping bodies are moved apart.
  void convertContacts(btPersistentManifold** manifolds, int count,
                       const btContactSolverInfo& info) override;
  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int body_count,
                                             btPersistentManifold** manifolds, int manifold_count,
                                             btTypedConstraint** joints, int joint_count,
                                             const btContactSolverInfo& info,
                                             btIDebugDraw* draw) override;

 private:
  ArticulatedSolver articulated_;
};

/// A world whose islands are bodies with contacts or joints between them.
class ContactIslandWorld : public btDiscreteDynamicsWorld {
 public:
  using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;

 protected:
  void calculateSimulationIslands() override;
};

/// Sets the key by which the solver orders a model's joints.
void mark(btTypedConstraint& joint, int model, int index);

}  // namespace kiva
