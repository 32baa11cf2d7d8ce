// SPDX-License-Identifier: Apache-2.0
#include "core/physics/bodies/joint_constraints.h"

#include "core/physics/bodies/conversions.h"

namespace kiva {
namespace {

/// Returns the joint frame in world: origin at the anchor, axis `along` (0 = x, 2 = z) on the
/// joint's axis.
btTransform jointFrame(const Joint& joint, const btTransform& model, int along) {
  const btVector3 axis = toBullet(joint.axis_in_model).normalized();
  btVector3 u, v;
  btPlaneSpace1(axis, u, v);
  const btMatrix3x3 basis =
      along == 0
          ? btMatrix3x3(axis.x(), u.x(), v.x(), axis.y(), u.y(), v.y(), axis.z(), u.z(), v.z())
          : btMatrix3x3(u.x(), v.x(), axis.x(), u.y(), v.y(), axis.y(), u.z(), v.z(), axis.z());
  return model * btTransform(basis, toBullet(joint.anchor_in_model));
}

std::unique_ptr<btTypedConstraint> makeHinge(const Joint& joint, const JointEnds& ends,
                                             const btTransform& model) {
  const btTransform frame = jointFrame(joint, model, 2);
  auto hinge = std::make_unique<btHingeConstraint>(
      ends.parent, ends.child, ends.parent.getWorldTransform().inverse() * frame,
      ends.child.getWorldTransform().inverse() * frame);
  // Bullet's angle of a hinge, from parent to child, has the opposite sign.
  if (joint.kind == Joint::Kind::kRevolute && joint.upper - joint.lower < 2 * SIMD_PI) {
    hinge->setLimit(-joint.upper, -joint.lower);
  }
  return hinge;
}

std::unique_ptr<btTypedConstraint> makeSlider(const Joint& joint, const JointEnds& ends,
                                              const btTransform& model) {
  const btTransform frame = jointFrame(joint, model, 0);
  auto slider = std::make_unique<btSliderConstraint>(
      ends.parent, ends.child, ends.parent.getWorldTransform().inverse() * frame,
      ends.child.getWorldTransform().inverse() * frame, true);
  slider->setLowerLinLimit(joint.lower);
  slider->setUpperLinLimit(joint.upper);
  slider->setLowerAngLimit(0);
  slider->setUpperAngLimit(0);
  return slider;
}

std::unique_ptr<btTypedConstraint> makeBall(const Joint& joint, const JointEnds& ends,
                                            const btTransform& model) {
  const btVector3 anchor = model * toBullet(joint.anchor_in_model);
  return std::make_unique<btPoint2PointConstraint>(
      ends.parent, ends.child, ends.parent.getWorldTransform().inverse() * anchor,
      ends.child.getWorldTransform().inverse() * anchor);
}

}  // namespace

std::unique_ptr<btTypedConstraint> makeJoint(const Joint& joint, const JointEnds& ends,
                                             const btTransform& model) {
  if (joint.kind == Joint::Kind::kPrismatic) return makeSlider(joint, ends, model);
  if (joint.kind == Joint::Kind::kBall) return makeBall(joint, ends, model);
  if (joint.kind != Joint::Kind::kFixed) return makeHinge(joint, ends, model);
  const btTransform frame = ends.child.getWorldTransform();
  return std::make_unique<btFixedConstraint>(ends.parent, ends.child,
                                             ends.parent.getWorldTransform().inverse() * frame,
                                             btTransform::getIdentity());
}

}  // namespace kiva
