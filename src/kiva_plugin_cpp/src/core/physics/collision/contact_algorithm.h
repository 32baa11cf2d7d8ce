// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <btBulletDynamicsCommon.h>

namespace kiva {

/// Base of algorithms that compute contacts of two bodies step by step, without times of impact.
class ContactAlgorithm : public btActivatingCollisionAlgorithm {
 public:
  using btActivatingCollisionAlgorithm::btActivatingCollisionAlgorithm;
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) final {
    return 1;
  }
};

}  // namespace kiva
