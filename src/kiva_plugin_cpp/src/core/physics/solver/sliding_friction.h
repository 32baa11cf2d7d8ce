// SPDX-License-Identifier: Apache-2.0
//
// Dry friction between the floor and a body that can only slide on it, as a constraint of Bullet:
// two rows for each foot in place of contacts at every corner.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <vector>

namespace kiva {

/// A point at which a body stands on the floor.
struct SlidingFoot {
  btVector3 at;           ///< Position from the centre of mass, in the body's frame [m].
  double grip_limit = 0;  ///< Largest friction force there [N].
};

class SlidingFriction : public btTypedConstraint {
 public:
  SlidingFriction(btRigidBody& body, std::vector<SlidingFoot> feet);

  void getInfo1(btConstraintInfo1* info) override;
  /// Adds impulses that end the motion of a foot along and across its way, within its grip.
  void getInfo2(btConstraintInfo2* info) override;
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

  const std::vector<SlidingFoot>& feet() const { return feet_; }
  /// Returns the direction of motion of a foot at `arm` [m] from the centre of mass: a unit vector
  /// in world.
  btVector3 wayOf(const btVector3& arm) const;
  /// Returns the impulse of the floor on the body in the last step of `dt` [s] in which it was
  /// awake, in world [Ns].
  btVector3 impulse(double dt) const { return feedback_.m_appliedForceBodyA * dt; }

 private:
  std::vector<SlidingFoot> feet_;
  btJointFeedback feedback_;
};

}  // namespace kiva
