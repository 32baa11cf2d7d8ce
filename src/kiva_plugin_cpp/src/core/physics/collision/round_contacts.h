// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <btBulletDynamicsCommon.h>

#include "core/physics/collision/contact_algorithm.h"

namespace kiva {

/// Contacts of a cylinder or a capsule with a plane or the face of a box, found again in every
/// step.
///
/// Bullet finds one point a step, at whichever end of the line of contact is lower by a rounding
/// error, and keeps that of the other end while it rolls up and away with the body: a rolling
/// cylinder gains energy by it, and a turning wheel scrubs over its edges. What is found here is
/// the line itself, as its middle and its ends, or four points of a cylinder's rim if it stands.
class RoundContacts : public ContactAlgorithm {
 public:
  /// `round` is the cylinder or capsule, `flat` the plane or box; where such a body is met at an
  /// edge of the box, what `at_edges` makes takes over.
  RoundContacts(const btCollisionAlgorithmConstructionInfo& info,
                const btCollisionObjectWrapper* round, const btCollisionObjectWrapper* flat,
                bool is_swapped, btCollisionAlgorithmCreateFunc* at_edges);
  ~RoundContacts() override;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* result) override;
  void getAllContactManifolds(btManifoldArray& manifolds) override;

  /// What a dispatcher is told to use for such a pair, in that order or swapped.
  struct Creator : btCollisionAlgorithmCreateFunc {
    Creator(bool is_swapped, btCollisionAlgorithmCreateFunc* edges) : at_edges(edges) {
      m_swapped = is_swapped;
    }
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
    btCollisionAlgorithmCreateFunc* at_edges;
  };

 private:
  bool is_swapped_;
  btPersistentManifold* manifold_;  // its first body is the round one
  btCollisionAlgorithm* edge_ = nullptr;
};

}  // namespace kiva
