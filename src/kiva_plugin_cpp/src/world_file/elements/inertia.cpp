// SPDX-License-Identifier: Apache-2.0
#include "world_file/elements/inertia.h"

#include "kiva_plugin_cpp/principal_inertia.h"
#include "world_file/elements/values.h"

namespace kiva {
namespace {

// Limits beyond which impulses are not finite.
constexpr double kMostMass = 1e9;     // [kg]
constexpr double kMostMoment = 1e12;  // [kg m²]

bool isMass(double mass) { return mass > 0 && mass <= kMostMass; }

/// Returns whether a body can have it: moments are positive, and none exceeds the sum of the other
/// two.
bool isPossible(double mass, const InertiaTensor& inertia) {
  return inertia.moments.IsFinite() && inertia.products.IsFinite() &&
         inertia.principalMoments().Min() > 0 && inertia.principalMoments().Max() <= kMostMoment &&
         inertia.isPossible(mass);
}

InertiaTensor tensorIn(const XmlElement& inertial) {
  InertiaTensor tensor{Vector3::One, Vector3::Zero};
  const XmlElement* const inertia = inertial.FirstChildElement("inertia");
  if (!inertia) return tensor;
  const auto moment = [&](const char* name, double otherwise) {
    return numberIn(*inertia, name, otherwise);
  };
  tensor.moments = {moment("ixx", 1), moment("iyy", 1), moment("izz", 1)};
  tensor.products = {moment("ixy", 0), moment("ixz", 0), moment("iyz", 0)};
  return tensor;
}

}  // namespace

void repairInertial(XmlElement* link, Faults* warnings) {
  XmlElement* const inertial = link->FirstChildElement("inertial");
  if (!inertial) return;
  const double mass = numberIn(*inertial, "mass", 1);
  if (!isMass(mass)) {
    const XmlElement* const inertia_element = inertial->FirstChildElement("mass");
    warnings->push_back(noteAt(*inertia_element, "expected a mass above 0 kg, 1e9 at most, found " +
                                                     contentOf(inertia_element) +
                                                     "; this link has 1 kg and 1 kg m² instead"));
    link->DeleteChild(inertial);
  } else if (!isPossible(mass, tensorIn(*inertial))) {
    XmlElement* const inertia = inertial->FirstChildElement("inertia");
    warnings->push_back(
        noteAt(*inertia,
               "no body has this inertia; expected finite principal moments above 0 kg m², none "
               "larger than the sum of the other two; this link has 1 kg m² instead"));
    inertial->DeleteChild(inertia);
  }
}

void setInertia(const XmlElement* inertial, Link* link) {
  if (!inertial) return;
  const InertiaTensor tensor = tensorIn(*inertial);
  link->mass = numberIn(*inertial, "mass", 1);
  link->principal_moments = tensor.principalMoments();
  const Pose axes(Vector3::Zero, tensor.principalAxes());
  link->inertial_pose_in_link = valueOfPose(inertial->FirstChildElement("pose")) * axes;
}

}  // namespace kiva
