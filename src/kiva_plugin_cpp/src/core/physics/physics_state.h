// SPDX-License-Identifier: Apache-2.0
//
// What makes Bullet's next step, read from bodies and joints and put back. In world, SI units.
#pragma once

#include <vector>

#include "core/physics/physics.h"

namespace kiva {

/// A body as Bullet leaves it after a step.
struct BodyState {
  btTransform pose, predicted_pose;
  btVector3 velocity, angular_velocity;
  btVector3 predicted_velocity, predicted_angular_velocity;
  btVector3 force, torque;  ///< For the next step.
  double mass = 0;
  btVector3 inverse_inertia;  ///< Along the principal axes.
  int activation = 0;
  bool placed = false;             ///< Since the last step.
  double resting = 0;              ///< Since it moved last [s].
  std::vector<btTransform> parts;  ///< In the body.
  std::vector<bool> faceted;       ///< Whose boxes know their faces and edges.
};

/// What a joint's motor was told last.
struct MotorState {
  bool powered = false;
  double speed = 0;   ///< [rad/s], [m/s]
  double effort = 0;  ///< In Bullet's units: a hinge's per step [Nms], a slider's [N].
};

BodyState readBody(const btRigidBody& body);
/// Throws std::invalid_argument if that is the state of a body with other parts.
void writeBody(const BodyState& state, btRigidBody& body);

MotorState readMotor(const btTypedConstraint& joint);
void writeMotor(const MotorState& state, btTypedConstraint& joint);

}  // namespace kiva
