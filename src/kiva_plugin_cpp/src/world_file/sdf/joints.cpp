// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "world_file/elements/frames.h"
#include "world_file/elements/values.h"
#include "world_file/sdf/links.h"

namespace kiva {
namespace {

constexpr double kUnlimited = 1e16;

/// Returns the kind of a joint; the checks refuse other types.
Joint::Kind kindOf(const XmlElement& joint) {
  const std::string type = attributeOf(joint, "type");
  if (type == "revolute") return Joint::Kind::kRevolute;
  if (type == "continuous") return Joint::Kind::kContinuous;
  if (type == "prismatic") return Joint::Kind::kPrismatic;
  return type == "ball" ? Joint::Kind::kBall : Joint::Kind::kFixed;
}

const XmlElement& modelOf(const XmlElement& joint) { return *joint.Parent()->ToElement(); }

/// Returns the link's name in the flattened model.
std::string scopedLink(const XmlElement& joint, const char* end, const Scope& scope) {
  const std::string link = linkOf(modelOf(joint), contentOf(joint.FirstChildElement(end)));
  return link == "world" ? link : scope.prefix + link;
}

double atLeastZero(const XmlElement& axis, const std::string& name, double value) {
  if (std::isfinite(value) && value >= 0) return value;
  failAt(axis, "expected a " + name + " of 0 or above");
}

void setLimits(const XmlElement& axis, Joint* joint) {
  const XmlElement* const limit = axis.FirstChildElement("limit");
  const auto number = [limit](const char* name, double otherwise) {
    return limit ? numberIn(*limit, name, otherwise) : otherwise;
  };
  const double lower = number("lower", -kUnlimited), upper = number("upper", kUnlimited);
  if (!(lower <= upper)) {  // Refuses NaN too.
    failAt(axis, "expected a lower limit at or below the upper one");
  }
  if (joint->kind != Joint::Kind::kContinuous) {
    joint->lower = std::clamp(lower, -kUnlimited, kUnlimited);
    joint->upper = std::clamp(upper, -kUnlimited, kUnlimited);
  }
  const auto most = [&](const char* name) {
    const double value = number(name, -1);
    return std::isfinite(value) && value >= 0 ? value : -1;
  };
  joint->max_effort = most("effort");
  joint->max_velocity = most("velocity");
}

/// Returns the unit vector of the axis in the model.
Vector3 directionOf(const XmlElement& joint, const XmlElement& axis) {
  const XmlElement* const xyz = axis.FirstChildElement("xyz");
  const Vector3 direction = (xyz ? vectorIn(*xyz) : Vector3::UnitZ).Normalized();
  const std::string frame = xyz ? attributeOf(*xyz, "expressed_in") : "";
  const Pose pose = frame.empty() ? poseAround(joint) : frameIn(modelOf(joint), frame);
  return pose.Rot().RotateVector(direction);
}

void setAxis(const XmlElement& from, const Scope& scope, Joint* joint) {
  const XmlElement* const axis = from.FirstChildElement("axis");
  if (!axis) failAt(from, "expected an <axis>");
  joint->axis_in_model = scope.pose.Rot().RotateVector(directionOf(from, *axis)).Normalized();
  setLimits(*axis, joint);
  const XmlElement* const dynamics = axis->FirstChildElement("dynamics");
  if (!dynamics) return;
  joint->damping = atLeastZero(*axis, "damping", numberIn(*dynamics, "damping", 0));
  joint->friction = atLeastZero(*axis, "friction", numberIn(*dynamics, "friction", 0));
  joint->stiffness =
      atLeastZero(*axis, "spring_stiffness", numberIn(*dynamics, "spring_stiffness", 0));
  joint->spring_reference = numberIn(*dynamics, "spring_reference", 0);
}

}  // namespace

Joint describeJoint(const XmlElement& from, const Scope& scope) {
  Joint joint;
  joint.name = scope.prefix + attributeOf(from, "name");
  joint.kind = kindOf(from);
  joint.parent = scopedLink(from, "parent", scope);
  joint.child = scopedLink(from, "child", scope);
  joint.anchor_in_model = (scope.pose * poseAround(from)).Pos();
  if (joint.hasAxis()) setAxis(from, scope, &joint);
  return joint;
}

}  // namespace kiva
