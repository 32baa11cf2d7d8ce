// SPDX-License-Identifier: Apache-2.0
//
// Dry friction between the floor and a body that can do nothing but slide on it, as a constraint of
// Bullet's: two rows a foot instead of the contacts of every corner.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <vector>

namespace kiva {

/// Where a body stands on the floor.
struct Foot {
  btVector3 at;           ///< From the centre of mass, in the body's frame [m].
  double grip_limit = 0;  ///< The most that friction holds there [N].
};

class SlidingFriction : public btTypedConstraint {
 public:
  SlidingFriction(btRigidBody& body, std::vector<Foot> feet);

  void getInfo1(btConstraintInfo1* info) override;
  /// Along the way that a foot goes, and across it: the impulses that end both, as far as it grips.
  void getInfo2(btConstraintInfo2* info) override;
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

  const std::vector<Foot>& feet() const { return feet_; }
  /// Returns where a foot goes, as far as `arm` [m] from the centre of mass: a unit vector, in
  /// world.
  btVector3 wayOf(const btVector3& arm) const;
  /// Returns the impulse of the floor on the body in the last step of `dt` [s] in which it was
  /// awake, in world [Ns].
  btVector3 impulse(double dt) const { return feedback_.m_appliedForceBodyA * dt; }

 private:
  std::vector<Foot> feet_;
  btJointFeedback feedback_;
};

}  // namespace kiva
