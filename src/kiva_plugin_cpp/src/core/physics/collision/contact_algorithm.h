// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <btBulletDynamicsCommon.h>

namespace kiva {

/// How contacts of two bodies are found, step by step: nothing here asks when they will touch.
class ContactAlgorithm : public btActivatingCollisionAlgorithm {
 public:
  using btActivatingCollisionAlgorithm::btActivatingCollisionAlgorithm;
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) final {
    return 1;
  }
};

}  // namespace kiva
