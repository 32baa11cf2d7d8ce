// SPDX-License-Identifier: Apache-2.0
//
// Bullet with its memory of the past taken out. As it comes, the outcome of a step depends on how
// the lists came to be that it goes through: the solver takes contacts in the order in which they
// were found, and bodies form an island when their boxes, grown in advance, overlap. Here a step
// follows from bodies, contacts and joints alone, so that a world put together from these goes on
// as the one that they were read from, bit by bit.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <vector>

#include "core/physics/solver/articulated_solver.h"

namespace kiva {

/// Marks every manifold with the parts of both bodies that it is about, in its companion ids.
class OrderedDispatcher : public btCollisionDispatcher {
 public:
  explicit OrderedDispatcher(btCollisionConfiguration* configuration);

  btPersistentManifold* getNewManifold(const btCollisionObject* a,
                                       const btCollisionObject* b) override;
  bool needsCollision(const btCollisionObject* a, const btCollisionObject* b) override;
  /// Those with contacts, by when their bodies came into the world, then by parts.
  std::vector<btPersistentManifold*> manifolds() const;
  /// One for every two parts that are near each other, also of bodies asleep; without contacts.
  std::vector<btPersistentManifold*> makeManifolds(btOverlappingPairCache* pairs,
                                                   const btDispatcherInfo& info);

 private:
  bool minds_sleepers_ = false;  ///< Those asleep are looked at, too.
};

/// Leaves out pairs of bodies of one model, unless it says that its links touch each other. Wheels
/// turn within the hull of a chassis, and what holds them is no contact.
class OwnPartsFilter : public btOverlapFilterCallback {
 public:
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override;
};

/// Goes through an island's contacts and joints in the order of their bodies. It expects to be
/// asked to move overlapping bodies apart without a change of their velocities.
class OrderedSolver : public btSequentialImpulseConstraintSolver {
 public:
  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** joints, int joint_count,
                      const btContactSolverInfo& info, btIDebugDraw* draw,
                      btDispatcher* dispatcher) override;

 protected:
  /// Bounds the speed with which overlapping bodies are moved apart.
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

/// Islands of bodies with contacts or joints between them.
class ContactIslandWorld : public btDiscreteDynamicsWorld {
 public:
  using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;

 protected:
  void calculateSimulationIslands() override;
};

/// What the solver orders a model's joints by.
void mark(btTypedConstraint& joint, int model, int index);

}  // namespace kiva
