// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kiva_plugin_cpp/description.h"
#include "kiva_plugin_cpp/principal_inertia.h"

namespace kiva {

/// Mass, centre and inertia of several bodies as one, in one frame.
class SpatialInertia {
 public:
  using Matrix = Matrix3;

  void add(const Link& link, const Pose& link_in_frame);
  void addPoint(double mass, const Vector3& at);
  /// Adds the inertia of another frame, which is at `pose` in this one.
  void add(const SpatialInertia& other, const Pose& pose);

  double mass() const { return mass_; }  ///< [kg]
  Vector3 centre() const { return mass_ > 0 ? moment_ / mass_ : Vector3::Zero; }
  /// Returns the moment of inertia about the frame's z axis [kg m²].
  double aboutZ() const { return about_origin_(2, 2); }
  /// Returns the inertia tensor about the centre, along the frame's axes [kg m²].
  Matrix inertia() const { return about_origin_ - ofPoint(mass_, centre()); }

 private:
  static Matrix ofPoint(double mass, const Vector3& at);
  void add(double mass, const Vector3& centre, const Matrix& about_centre);

  double mass_ = 0;
  Vector3 moment_;  // sum of mass · position
  Matrix about_origin_{0, 0, 0, 0, 0, 0, 0, 0, 0};
};

}  // namespace kiva
