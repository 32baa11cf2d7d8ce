// SPDX-License-Identifier: Apache-2.0
#include "core/physics/physics_state.h"

#include <stdexcept>

namespace kiva {
namespace {

bool isFaceted(const btCollisionShape* part) {
  return part->isPolyhedral() &&
         static_cast<const btPolyhedralConvexShape*>(part)->getConvexPolyhedron() != nullptr;
}

void readParts(const btCompoundShape& shape, BodyState* state) {
  for (int i = 0; i < shape.getNumChildShapes(); ++i) {
    state->parts.push_back(shape.getChildTransform(i));
    state->faceted.push_back(isFaceted(shape.getChildShape(i)));
  }
}

void writeParts(const BodyState& state, btCompoundShape& shape) {
  const int count = shape.getNumChildShapes();
  if (static_cast<int>(state.parts.size()) != count ||
      static_cast<int>(state.faceted.size()) != count) {
    throw std::invalid_argument("a body has other parts than its model");
  }
  for (int i = 0; i < count; ++i) {
    shape.updateChildTransform(i, state.parts[i], false);
    btCollisionShape* part = shape.getChildShape(i);
    if (!state.faceted[i] || isFaceted(part)) continue;
    if (!part->isPolyhedral()) throw std::invalid_argument("a body without faces has some");
    static_cast<btPolyhedralConvexShape*>(part)->initializePolyhedralFeatures();
  }
  shape.recalculateLocalAabb();
}

}  // namespace

BodyState readBody(const btRigidBody& body) {
  BodyState s;
  s.pose = body.getWorldTransform();
  s.predicted_pose = body.getInterpolationWorldTransform();
  s.velocity = body.getLinearVelocity();
  s.angular_velocity = body.getAngularVelocity();
  s.predicted_velocity = body.getInterpolationLinearVelocity();
  s.predicted_angular_velocity = body.getInterpolationAngularVelocity();
  s.force = body.getTotalForce();
  s.torque = body.getTotalTorque();
  s.mass = body.getMass();
  s.inverse_inertia = body.getInvInertiaDiagLocal();
  s.activation = body.getActivationState();
  s.placed = body.getUserIndex3() == kPlaced;
  s.resting = body.getDeactivationTime();
  readParts(*static_cast<const btCompoundShape*>(body.getCollisionShape()), &s);
  return s;
}

void writeBody(const BodyState& s, btRigidBody& body) {
  writeParts(s, *static_cast<btCompoundShape*>(body.getCollisionShape()));
  body.setMassProps(s.mass, btVector3(1, 1, 1));
  body.setInvInertiaDiagLocal(s.inverse_inertia);
  body.setWorldTransform(s.pose);
  body.setInterpolationWorldTransform(s.predicted_pose);
  body.setLinearVelocity(s.velocity);
  body.setAngularVelocity(s.angular_velocity);
  body.setInterpolationLinearVelocity(s.predicted_velocity);
  body.setInterpolationAngularVelocity(s.predicted_angular_velocity);
  body.updateInertiaTensor();
  body.clearForces();
  body.applyCentralForce(s.force);
  body.applyTorque(s.torque);
  body.forceActivationState(s.activation);
  body.setDeactivationTime(s.resting);
  body.setUserIndex3(s.placed ? kPlaced : -1);
}

MotorState readMotor(const btTypedConstraint& joint) {
  MotorState state;
  if (joint.getConstraintType() == HINGE_CONSTRAINT_TYPE) {
    auto& hinge = const_cast<btHingeConstraint&>(static_cast<const btHingeConstraint&>(joint));
    state = {hinge.getEnableAngularMotor(), hinge.getMotorTargetVelocity(),
             hinge.getMaxMotorImpulse()};
  } else if (joint.getConstraintType() == SLIDER_CONSTRAINT_TYPE) {
    auto& slider = const_cast<btSliderConstraint&>(static_cast<const btSliderConstraint&>(joint));
    state = {slider.getPoweredLinMotor(), slider.getTargetLinMotorVelocity(),
             slider.getMaxLinMotorForce()};
  }
  return state;
}

void writeMotor(const MotorState& state, btTypedConstraint& joint) {
  if (joint.getConstraintType() == HINGE_CONSTRAINT_TYPE) {
    static_cast<btHingeConstraint&>(joint).enableAngularMotor(state.powered, state.speed,
                                                              state.effort);
  } else if (joint.getConstraintType() == SLIDER_CONSTRAINT_TYPE) {
    auto& slider = static_cast<btSliderConstraint&>(joint);
    slider.setPoweredLinMotor(state.powered);
    slider.setTargetLinMotorVelocity(state.speed);
    slider.setMaxLinMotorForce(state.effort);
  }
}

}  // namespace kiva
