// SPDX-License-Identifier: Apache-2.0
#include "world_file/inertia.h"

#include "kiva_plugin_cpp/principal_inertia.h"
#include "world_file/errors.h"
#include "world_file/from_sdformat.h"

namespace kiva {
namespace {

// Beyond, impulses are no finite numbers any more.
constexpr double kMostMass = 1e9;     // [kg]
constexpr double kMostMoment = 1e12;  // [kg m²]

bool isMass(double mass) { return mass > 0 && mass <= kMostMass; }

/// A body's moments are positive, and none exceeds the sum of the other two.
bool isPossible(double mass, const InertiaTensor& inertia) {
  return inertia.moments.IsFinite() && inertia.products.IsFinite() &&
         inertia.principalMoments().Min() > 0 && inertia.principalMoments().Max() <= kMostMoment &&
         inertia.isPossible(mass);
}

bool hasPossibleMoments(const sdf::ElementPtr& inertial) {
  const sdf::ElementPtr inertia = inertial->FindElement("inertia");
  if (!inertia) return true;
  const auto moment = [&](const char* name, double fallback) {
    return inertia->Get<double>(name, fallback).first;
  };
  const InertiaTensor tensor{{moment("ixx", 1), moment("iyy", 1), moment("izz", 1)},
                             {moment("ixy", 0), moment("ixz", 0), moment("iyz", 0)}};
  return isPossible(inertial->Get<double>("mass", 1.0).first, tensor);
}

}  // namespace

void repairInertial(const sdf::ElementPtr& link, sdf::Errors* warnings) {
  const sdf::ElementPtr inertial = link->FindElement("inertial");
  if (!inertial) return;
  if (!isMass(inertial->Get<double>("mass", 1.0).first)) {
    warnings->push_back(
        noteAt(inertial->FindElement("mass"), "expected a mass above 0 kg, 1e9 at most, found " +
                                                  inertial->Get<std::string>("mass") +
                                                  "; this link has 1 kg and 1 kg m² instead"));
    link->RemoveChild(inertial);
  } else if (!hasPossibleMoments(inertial)) {
    const sdf::ElementPtr inertia = inertial->FindElement("inertia");
    warnings->push_back(
        noteAt(inertia,
               "no body has this inertia; expected finite principal moments above 0 kg m², none "
               "larger than the sum of the other two; this link has 1 kg m² instead"));
    inertial->RemoveChild(inertia);
  }
}

void setInertia(const ignition::math::Inertiald& inertial, Link* link) {
  const ignition::math::MassMatrix3d& matrix = inertial.MassMatrix();
  const InertiaTensor tensor{fromSdformat(matrix.DiagonalMoments()),
                             fromSdformat(matrix.OffDiagonalMoments())};
  link->mass = matrix.Mass();
  link->principal_moments = tensor.principalMoments();
  const Pose axes(Vector3::Zero, tensor.principalAxes());
  link->inertial_pose_in_link = fromSdformat(inertial.Pose()) * axes;
}

}  // namespace kiva
