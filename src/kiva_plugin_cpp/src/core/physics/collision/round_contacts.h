// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <btBulletDynamicsCommon.h>

#include "core/physics/collision/contact_algorithm.h"

namespace kiva {

/// Contacts of a cylinder or a capsule with a plane or the face of a box, computed again in every
/// step.
/// Bullet adds one point a step, at whichever end of the contact line is lower by a rounding error,
/// and keeps the point of the other end while that rolls up and away with the body. So a rolling
/// cylinder gains energy, and a turning wheel scrubs over its edges. This algorithm gives the whole
/// line, as its middle and its ends, or four points of the rim of a standing cylinder.
class RoundContacts : public ContactAlgorithm {
 public:
  /// `round` is the cylinder or capsule, `flat` the plane or box. Where the round body touches an
  /// edge of the box, the algorithm that `at_edges` makes takes over.
  RoundContacts(const btCollisionAlgorithmConstructionInfo& info,
                const btCollisionObjectWrapper* round, const btCollisionObjectWrapper* flat,
                bool is_swapped, btCollisionAlgorithmCreateFunc* at_edges);
  ~RoundContacts() override;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* result) override;
  void getAllContactManifolds(btManifoldArray& manifolds) override;

  /// Creates the algorithm for such a pair, in that order or swapped.
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
