// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <BulletCollision/CollisionDispatch/btCompoundCompoundCollisionAlgorithm.h>
#include <btBulletDynamicsCommon.h>

#include <vector>

#include "core/geometry/rectangle_contacts.h"
#include "core/physics/collision/contact_algorithm.h"

namespace kiva {

/// Returns whether the body can only slide and turn on the floor.
bool isPlanar(const btRigidBody& body);

/// Contacts between bodies of upright boxes that stay upright, one of which is planar: two points
/// wherever outlines come near.
class PlanarContacts : public ContactAlgorithm {
 public:
  /// Two parts with common heights, and their contacts.
  struct Pair {
    int a = 0, b = 0;                          ///< Children of the compounds.
    double z_min = 0, z_max = 0;               ///< Common heights, in world [m].
    btPersistentManifold* manifold = nullptr;  ///< Null until they come near.
    OutlineContacts contacts;                  ///< Contacts of the last test.
  };

  PlanarContacts(const btCollisionAlgorithmConstructionInfo& info,
                 const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                 std::vector<Pair> pairs, const Rectangle& hull_a, const Rectangle& hull_b);
  ~PlanarContacts() override;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* result) override;
  void getAllContactManifolds(btManifoldArray& manifolds) override;

  /// Creates the algorithm for two compounds: this one, or Bullet's own if a compound may tip or
  /// has parts other than upright boxes.
  struct Creator : btCompoundCompoundCollisionAlgorithm::CreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
  };

 private:
  void forget();
  /// Returns whether the pair may touch soon; it has a manifold then.
  bool findPairContacts(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        double reach, Pair* pair);
  double heightOfPush(double centre) const;

  std::vector<Pair> pairs_;
  Rectangle hull_a_, hull_b_;  ///< The hulls of all their parts, in the bodies' frames.
};

}  // namespace kiva
