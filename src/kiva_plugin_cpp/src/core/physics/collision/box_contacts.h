// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btDiscreteCollisionDetectorInterface.h>
#include <btBulletDynamicsCommon.h>

#include "core/physics/collision/contact_algorithm.h"

namespace kiva {

/// Contacts of two boxes, foreseen while they are still apart.
/// Each of Bullet's two algorithms alone lets fast boxes sink into each other: its box-box detector
/// sees overlapping boxes only, and GJK loses the contact once a corner is inside. So GJK computes
/// the distance while there is one, its normal gives the whole patch between the opposing faces,
/// and the detector takes over where boxes overlap.
class BoxBoxContacts : public ContactAlgorithm {
 public:
  BoxBoxContacts(const btCollisionAlgorithmConstructionInfo& info,
                 const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b);
  ~BoxBoxContacts() override;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* result) override;
  void getAllContactManifolds(btManifoldArray& manifolds) override;

  /// Creates the algorithm for two boxes; registered with a dispatcher.
  struct Creator : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
  };

 private:
  void foresee(const btBoxShape* a, const btBoxShape* b,
               const btDiscreteCollisionDetectorInterface::ClosestPointInput& input,
               btManifoldResult* result);

  btPersistentManifold* manifold_;
  btAlignedObjectArray<btVector3> scratch_[2];  // memory for clipping
};

}  // namespace kiva
