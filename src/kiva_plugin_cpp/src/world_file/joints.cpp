// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <sdf/JointAxis.hh>

#include "world_file/elements.h"
#include "world_file/errors.h"
#include "world_file/links.h"

namespace kiva {
namespace {

constexpr double kUnlimited = 1e16;

/// Returns the kind of a joint; other types don't pass the checks.
Joint::Kind kindOf(const sdf::Joint& joint) {
  switch (joint.Type()) {
    case sdf::JointType::REVOLUTE:
      return Joint::Kind::kRevolute;
    case sdf::JointType::CONTINUOUS:
      return Joint::Kind::kContinuous;
    case sdf::JointType::PRISMATIC:
      return Joint::Kind::kPrismatic;
    case sdf::JointType::BALL:
      return Joint::Kind::kBall;
    default:
      return Joint::Kind::kFixed;
  }
}

/// Returns the link's name in the flattened model.
std::string scopedLink(const std::string& name, const Scope& scope) {
  return name == "world" ? name : scope.prefix + name;
}

void setEnds(const sdf::Joint& from, const Scope& scope, Joint* joint) {
  sdf::Errors errors = from.ResolveParentLink(joint->parent);
  const sdf::Errors more = from.ResolveChildLink(joint->child);
  errors.insert(errors.end(), more.begin(), more.end());
  if (!errors.empty()) failAt(from.Element(), errors.front().Message());
  joint->parent = scopedLink(joint->parent, scope);
  joint->child = scopedLink(joint->child, scope);
}

double atLeastZero(const sdf::ElementPtr& axis, const std::string& name, double value) {
  if (std::isfinite(value) && value >= 0) return value;
  failAt(axis, "expected a " + name + " of 0 or above");
}

void setLimits(const sdf::JointAxis& axis, Joint* joint) {
  if (!(axis.Lower() <= axis.Upper())) {  // Refuses NaN too.
    failAt(axis.Element(), "expected a lower limit at or below the upper one");
  }
  if (joint->kind != Joint::Kind::kContinuous) {
    joint->lower = std::clamp(axis.Lower(), -kUnlimited, kUnlimited);
    joint->upper = std::clamp(axis.Upper(), -kUnlimited, kUnlimited);
  }
  const auto limit = [](double value) { return std::isfinite(value) && value >= 0 ? value : -1; };
  joint->max_effort = limit(axis.Effort());
  joint->max_velocity = limit(axis.MaxVelocity());
}

void setAxis(const sdf::Joint& from, const Scope& scope, Joint* joint) {
  const sdf::JointAxis* axis = from.Axis(0);
  if (!axis) failAt(from.Element(), "expected an <axis>");
  Vector3 direction;
  const sdf::Errors errors = axis->ResolveXyz(direction, "__model__");
  if (!errors.empty()) failAt(axis->Element(), errors.front().Message());
  joint->axis_in_model = scope.pose.Rot().RotateVector(direction).Normalized();
  setLimits(*axis, joint);
  joint->damping = atLeastZero(axis->Element(), "damping", axis->Damping());
  joint->friction = atLeastZero(axis->Element(), "friction", axis->Friction());
}

}  // namespace

Joint describeJoint(const sdf::Joint& from, const Scope& scope) {
  Joint joint;
  joint.name = scope.prefix + from.Name();
  joint.kind = kindOf(from);
  setEnds(from, scope, &joint);
  const Pose pose = resolved(from.SemanticPose(), from.Element(), "__model__");
  joint.anchor_in_model = (scope.pose * pose).Pos();
  if (joint.hasAxis()) setAxis(from, scope, &joint);
  return joint;
}

}  // namespace kiva
