// SPDX-License-Identifier: Apache-2.0
#include "core/physics/solver/ordered_bullet.h"

#include <BulletCollision/CollisionDispatch/btCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCompoundCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>

#include <algorithm>
#include <tuple>

#include "core/physics/collision/collision_groups.h"
#include "core/physics/collision/parting.h"
#include "core/physics/solver/planar_solver.h"

namespace kiva {
namespace {

/// The parts of two compounds that Bullet tests next; it reports them through a global hook only.
thread_local const btCollisionShape* near_parts[2];

bool noteParts(const btCollisionShape* a, const btCollisionShape* b) {
  near_parts[0] = a;
  near_parts[1] = b;
  return true;
}

/// Returns the index of that part in the body; 0 for a body with one part.
int nearPart(const btCollisionObject* body) {
  if (!body->getCollisionShape()->isCompound()) return 0;
  const auto* compound = static_cast<const btCompoundShape*>(body->getCollisionShape());
  for (int i = 0; i < compound->getNumChildShapes(); ++i) {
    const btCollisionShape* part = compound->getChildShape(i);
    if (part == near_parts[0] || part == near_parts[1]) return i;
  }
  return 0;
}

int arrivalOf(const btCollisionObject* body) { return body->getBroadphaseHandle()->getUid(); }

bool comesBefore(const btPersistentManifold* a, const btPersistentManifold* b) {
  const auto key = [](const btPersistentManifold* m) {
    return std::make_tuple(arrivalOf(m->getBody0()), arrivalOf(m->getBody1()), m->m_companionIdA,
                           m->m_companionIdB);
  };
  return key(a) < key(b);
}

bool jointComesBefore(const btTypedConstraint* a, const btTypedConstraint* b) {
  const auto key = [](const btTypedConstraint* joint) {
    return std::make_pair(joint->getUserConstraintType(), joint->getUserConstraintId());
  };
  return key(a) < key(b);
}

/// Returns whether a constraint joins links of a model; contacts with the floor are constraints as
/// well.
bool isJoint(const btTypedConstraint* constraint) {
  return constraint->getConstraintType() != MAX_CONSTRAINT_TYPE;
}

bool touches(const btPersistentManifold* manifold) { return manifold->getNumContacts() > 0; }

}  // namespace

OrderedDispatcher::OrderedDispatcher(btCollisionConfiguration* configuration)
    : btCollisionDispatcher(configuration) {
  gCompoundChildShapePairCallback = noteParts;
  gCompoundCompoundChildShapePairCallback = noteParts;
}

btPersistentManifold* OrderedDispatcher::getNewManifold(const btCollisionObject* a,
                                                        const btCollisionObject* b) {
  btPersistentManifold* manifold = btCollisionDispatcher::getNewManifold(a, b);
  manifold->m_companionIdA = nearPart(a);
  manifold->m_companionIdB = nearPart(b);
  return manifold;
}

bool OrderedDispatcher::needsCollision(const btCollisionObject* a, const btCollisionObject* b) {
  if (!minds_sleepers_) return btCollisionDispatcher::needsCollision(a, b);
  return a->checkCollideWith(b) && b->checkCollideWith(a);
}

std::vector<btPersistentManifold*> OrderedDispatcher::makeManifolds(btOverlappingPairCache* pairs,
                                                                    const btDispatcherInfo& info) {
  minds_sleepers_ = true;
  dispatchAllCollisionPairs(pairs, info, this);
  minds_sleepers_ = false;
  for (int i = 0; i < m_manifoldsPtr.size(); ++i) m_manifoldsPtr[i]->clearManifold();
  return {getInternalManifoldPointer(), getInternalManifoldPointer() + m_manifoldsPtr.size()};
}

bool OwnPartsFilter::needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const {
  const int of_a = a->m_collisionFilterGroup, of_b = b->m_collisionFilterGroup;
  if (!(of_a & b->m_collisionFilterMask) || !(of_b & a->m_collisionFilterMask)) return false;
  if ((of_a | of_b) & kSelfCollidingGroup) return true;
  const auto modelOf = [](const btBroadphaseProxy* proxy) {
    return static_cast<const btCollisionObject*>(proxy->m_clientObject)->getUserIndex();
  };
  return modelOf(a) != modelOf(b);
}

std::vector<btPersistentManifold*> OrderedDispatcher::manifolds() const {
  std::vector<btPersistentManifold*> out;
  for (int i = 0; i < m_manifoldsPtr.size(); ++i) {
    if (touches(m_manifoldsPtr[i])) out.push_back(m_manifoldsPtr[i]);
  }
  std::sort(out.begin(), out.end(), comesBefore);
  return out;
}

btScalar OrderedSolver::solveGroup(btCollisionObject** bodies, int body_count,
                                   btPersistentManifold** manifolds, int manifold_count,
                                   btTypedConstraint** joints, int joint_count,
                                   const btContactSolverInfo& info, btIDebugDraw* draw,
                                   btDispatcher* dispatcher) {
  // A manifold without contacts may belong to a body of another island, which the solver must not
  // move twice.
  btPersistentManifold** const end = std::partition(manifolds, manifolds + manifold_count, touches);
  std::sort(manifolds, end, comesBefore);
  std::sort(joints, joints + joint_count, jointComesBefore);
  const auto touching = static_cast<int>(end - manifolds);
  const ContactIsland island{bodies, body_count, manifolds, touching, joints, joint_count};
  if (isPlanar(island)) {
    solvePlanar(island, info);
    return 0;
  }
  btContactSolverInfo own = info;
  if (std::any_of(joints, joints + joint_count, isJoint)) {
    own.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  }
  return btSequentialImpulseConstraintSolver::solveGroup(
      bodies, body_count, manifolds, touching, joints, joint_count, own, draw, dispatcher);
}

btScalar OrderedSolver::solveGroupCacheFriendlyIterations(
    btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
    int manifold_count, btTypedConstraint** joints, int joint_count,
    const btContactSolverInfo& info, btIDebugDraw* draw) {
  if (std::any_of(joints, joints + joint_count, isJoint)) {
    const bool is_solved = articulated_.solve(
        {m_tmpSolverBodyPool, m_tmpSolverNonContactConstraintPool, m_tmpSolverContactConstraintPool,
         m_tmpSolverContactFrictionConstraintPool});
    if (is_solved) {
      solveGroupCacheFriendlySplitImpulseIterations(bodies, body_count, manifolds, manifold_count,
                                                    joints, joint_count, info, draw);
      return 0;
    }
  }
  return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyIterations(
      bodies, body_count, manifolds, manifold_count, joints, joint_count, info, draw);
}

void OrderedSolver::convertContacts(btPersistentManifold** manifolds, int count,
                                    const btContactSolverInfo& info) {
  btSequentialImpulseConstraintSolver::convertContacts(manifolds, count, info);
  for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); ++i) {
    btSolverConstraint& contact = m_tmpSolverContactConstraintPool[i];
    const btScalar most = kMaxPartingSpeed * contact.m_jacDiagABInv;
    contact.m_rhsPenetration = std::min(contact.m_rhsPenetration, most);
  }
}

void ContactIslandWorld::calculateSimulationIslands() {
  btSimulationIslandManager& islands = *getSimulationIslandManager();
  islands.updateActivationState(getCollisionWorld(), getDispatcher());  // numbers the bodies
  islands.initUnionFind(islands.getUnionFind().getNumElements());       // discards its own unions
  const auto unite = [&](const btCollisionObject& a, const btCollisionObject& b) {
    if (!a.mergesSimulationIslands() || !b.mergesSimulationIslands()) return;
    islands.getUnionFind().unite(a.getIslandTag(), b.getIslandTag());
  };
  for (int i = 0; i < getDispatcher()->getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *getDispatcher()->getManifoldByIndexInternal(i);
    if (touches(&manifold)) unite(*manifold.getBody0(), *manifold.getBody1());
  }
  for (int i = 0; i < m_constraints.size(); ++i) {
    if (!m_constraints[i]->isEnabled()) continue;
    unite(m_constraints[i]->getRigidBodyA(), m_constraints[i]->getRigidBodyB());
  }
  islands.storeIslandActivationState(getCollisionWorld());
}

void mark(btTypedConstraint& joint, int model, int index) {
  joint.setUserConstraintType(model);
  joint.setUserConstraintId(index);
}

}  // namespace kiva
