// SPDX-License-Identifier: Apache-2.0
#include "core/physics/bodies/spatial_inertia.h"

namespace kiva {

SpatialInertia::Matrix SpatialInertia::ofPoint(double mass, const Vector3& at) {
  const double x = at.X(), y = at.Y(), z = at.Z();
  return Matrix(mass * (y * y + z * z), -mass * x * y, -mass * x * z,  //
                -mass * x * y, mass * (x * x + z * z), -mass * y * z,  //
                -mass * x * z, -mass * y * z, mass * (x * x + y * y));
}

void SpatialInertia::add(double mass, const Vector3& centre, const Matrix& about_centre) {
  mass_ += mass;
  moment_ += centre * mass;
  about_origin_ = about_origin_ + about_centre + ofPoint(mass, centre);
}

void SpatialInertia::add(const Link& link, const Pose& link_in_frame) {
  const Pose centre = link_in_frame * link.inertial_pose_in_link;
  const Matrix turn(centre.Rot());
  const Vector3& m = link.principal_moments;
  const Matrix principal(m.X(), 0, 0, 0, m.Y(), 0, 0, 0, m.Z());
  add(link.mass, centre.Pos(), turn * principal * turn.Transposed());
}

void SpatialInertia::addPoint(double mass, const Vector3& at) {
  add(mass, at, Matrix(0, 0, 0, 0, 0, 0, 0, 0, 0));
}

void SpatialInertia::add(const SpatialInertia& other, const Pose& pose) {
  const Matrix turn(pose.Rot());
  add(other.mass(), pose.Pos() + pose.Rot().RotateVector(other.centre()),
      turn * other.inertia() * turn.Transposed());
}

}  // namespace kiva
