// SPDX-License-Identifier: Apache-2.0
//
// Inertia tensors, and the axes along which they have no products of inertia.
#pragma once

#include "kiva_plugin_cpp/geometry.h"

namespace kiva {

/// Three by three numbers, by row and column from 0.
class Matrix3 {
 public:
  constexpr Matrix3() = default;
  constexpr Matrix3(double m00, double m01, double m02, double m10, double m11, double m12,
                    double m20, double m21, double m22)
      : data_{{m00, m01, m02}, {m10, m11, m12}, {m20, m21, m22}} {}
  /// The rotation as a matrix.
  explicit Matrix3(const Quaternion& rotation);

  constexpr double operator()(int row, int column) const { return data_[row][column]; }
  constexpr double& operator()(int row, int column) { return data_[row][column]; }
  Matrix3 operator+(const Matrix3& m) const;
  Matrix3 operator-(const Matrix3& m) const;
  Matrix3 operator*(const Matrix3& m) const;
  Vector3 operator*(const Vector3& v) const;
  Matrix3 Transposed() const;
  double Determinant() const;

 private:
  double data_[3][3] = {};
};

/// An inertia tensor about the centre of mass, along the axes of a frame [kg m²].
struct InertiaTensor {
  Vector3 moments;   ///< Ixx, Iyy, Izz.
  Vector3 products;  ///< Ixy, Ixz, Iyz, as they stand in the tensor: the negative integrals.

  Matrix3 matrix() const;
  /// Whether a body of that mass [kg] can have it: nothing is negative, and no principal moment
  /// exceeds the sum of the others.
  bool isPossible(double mass) const;
  /// The moments about the principal axes, in ascending order; as they are if the products are
  /// negligible against the largest moment (`tolerance` times that).
  Vector3 principalMoments(double tolerance = kNegligible) const;
  /// Turns the frame's axes to the principal ones, in the order of principalMoments(). Of axes that
  /// several would do for, those nearest at hand; none where all three moments are about equal.
  Quaternion principalAxes() const;
};

}  // namespace kiva
