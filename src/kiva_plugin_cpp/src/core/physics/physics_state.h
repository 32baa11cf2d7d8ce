// SPDX-License-Identifier: Apache-2.0
//
// The state that determines Bullet's next step, read from bodies and joints, and written back. In
// world, SI units.
#pragma once

#include <vector>

#include "core/physics/physics.h"

namespace kiva {

/// The state of a body after a step.
struct BodyState {
  btTransform pose, predicted_pose;
  btVector3 velocity, angular_velocity;
  btVector3 predicted_velocity, predicted_angular_velocity;
  btVector3 force, torque;  ///< Forces of the next step.
  double mass = 0;
  btVector3 inverse_inertia;  ///< Inverse moments along the principal axes.
  int activation = 0;
  bool placed = false;             ///< Placed since the last step.
  double resting = 0;              ///< Time since its last motion [s].
  std::vector<btTransform> parts;  ///< Poses of the parts in the body.
  std::vector<bool> faceted;       ///< Whether each part's box has computed its faces and edges.
};

/// The last command of a joint's motor.
struct MotorState {
  bool powered = false;
  double speed = 0;  ///< [rad/s], [m/s]
  double effort =
      0;  ///< Largest effort in Bullet's units: [Nms] a step for a hinge, [N] for a slider.
};

BodyState readBody(const btRigidBody& body);
/// Throws std::invalid_argument if the state belongs to a body with other parts.
void writeBody(const BodyState& state, btRigidBody& body);

MotorState readMotor(const btTypedConstraint& joint);
void writeMotor(const MotorState& state, btTypedConstraint& joint);

}  // namespace kiva
